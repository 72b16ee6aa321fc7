#pragma once

#include <concepts>
#include <type_traits>

namespace faultsim {

/// That struct, const or not: for lists of members that are read and written.
template <typename Struct, typename Plain>
concept Of = std::same_as<std::remove_const_t<Struct>, Plain>;

}  // namespace faultsim
