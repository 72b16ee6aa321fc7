#pragma once

#include <string_view>

namespace faultsim {

/// Writes all of the bytes to a descriptor, however many pieces that takes. Throws StorageError
/// where nobody reads them any more.
void write_all(int descriptor, std::string_view bytes);

}  // namespace faultsim
