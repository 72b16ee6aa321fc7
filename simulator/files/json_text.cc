#include "simulator/files/json_text.h"

#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/common/printable.h"

namespace faultsim {
namespace {

constexpr int kDocumentFormat = 1;

template <typename Json>
std::string text_of(Json document) {
  FAULTSIM_DEMAND(document.is_object(), "a command prints an object, not ", document.type_name());
  if (!document.contains("format")) {
    Json with_format = {{"format", kDocumentFormat}};
    with_format.update(document);
    document = std::move(with_format);
  }
  // JSON leaves DEL, C1 and what turns the direction of writing as they are; here \uXXXX stands in
  // their place, which reads the same.
  const std::string text = document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return printable(text, Keep::line_ends);
}

}  // namespace

std::string json_text(nlohmann::json document) { return text_of(std::move(document)); }
std::string json_text(nlohmann::ordered_json document) { return text_of(std::move(document)); }

}  // namespace faultsim
