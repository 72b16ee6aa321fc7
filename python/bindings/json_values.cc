#include <nlohmann/json.hpp>

#include "python/bindings/bindings.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

template <typename Json>
py::object python_of(const Json& value) {
  switch (value.type()) {
    case Json::value_t::object: {
      py::dict members;
      for (const auto& [key, member] : value.items())
        members[py::str(key)] = python_of<Json>(member);
      return members;
    }
    case Json::value_t::array: {
      py::list elements;
      for (const Json& element : value) elements.append(python_of<Json>(element));
      return elements;
    }
    case Json::value_t::string:
      return py::str(value.template get_ref<const std::string&>());
    case Json::value_t::boolean:
      return py::bool_(value.template get<bool>());
    case Json::value_t::number_integer:
      return py::int_(value.template get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return py::int_(value.template get<std::uint64_t>());
    case Json::value_t::number_float:
      return py::float_(value.template get<double>());
    case Json::value_t::null:
    case Json::value_t::binary:
    case Json::value_t::discarded:
      return py::none();
  }
  return py::none();
}

}  // namespace

py::object to_python(const nlohmann::json& value) { return python_of(value); }
py::object to_python(const nlohmann::ordered_json& value) { return python_of(value); }

}  // namespace faultsim::python
