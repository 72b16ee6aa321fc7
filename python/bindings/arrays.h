#pragma once

#include <pybind11/numpy.h>

#include <vector>

namespace faultsim::python {

inline constexpr auto kNumberBytes = static_cast<pybind11::ssize_t>(sizeof(double));

/// A view of memory that belongs to `owner`, which it keeps; it cannot be written to.
/// @param strides  bytes; empty = rows one after the other.
template <typename T>
pybind11::array_t<T> view(const T* data, std::vector<pybind11::ssize_t> shape,
                          pybind11::handle owner, std::vector<pybind11::ssize_t> strides = {}) {
  pybind11::array_t<T> array =
      strides.empty() ? pybind11::array_t<T>(std::move(shape), data, owner)
                      : pybind11::array_t<T>(std::move(shape), std::move(strides), data, owner);
  pybind11::detail::array_proxy(array.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

}  // namespace faultsim::python
