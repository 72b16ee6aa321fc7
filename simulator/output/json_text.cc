#include "simulator/output/json_text.h"

#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr int kFormat = 1;

template <typename Json>
std::string text_of(Json document) {
  FAULTSIM_DEMAND(document.is_object(), "a command prints an object, not ", document.type_name());
  if (!document.contains("format")) {
    Json with_format = {{"format", kFormat}};
    with_format.update(document);
    document = std::move(with_format);
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string json_text(nlohmann::json document) { return text_of(std::move(document)); }
std::string json_text(nlohmann::ordered_json document) { return text_of(std::move(document)); }

}  // namespace faultsim
