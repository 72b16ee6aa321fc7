#include "simulator/app/request_check.h"

#include "simulator/common/errors.h"
#include "simulator/documents/schema.h"
#include "worker_run_schema_text.h"

namespace faultsim {

using nlohmann::json;

json request_of_line(const std::string& text, int number) {
  const auto refuse = [&](const std::string& what) {
    throw InputError("requests",
                     {{"", number, what,
                       "write {\"base\": 1, \"scene\": {...}}, {\"run\": 17, \"base\": "
                       "1, \"changes\": {...}} or {\"cancel\": 17}, each in one line"}});
  };
  json request = json::parse(text, nullptr, false);
  if (request.is_discarded()) refuse("the line is not JSON");
  if (!request.is_object()) refuse(concat(as_text(request), " is not a request"));
  const auto has_number = [&](const char* key) {
    return request.contains(key) && request[key].is_number_integer();
  };
  if (request.contains("scene")) {
    if (!has_number("base")) refuse("a base scene without its number");
  } else if (!has_number("run") && !has_number("cancel")) {
    refuse(request.contains("run") || request.contains("cancel")
               ? "a run without its number"
               : "neither a base scene nor a run nor a cancellation");
  }
  request["line"] = number;
  return request;
}

void require_run(const json& run, const std::map<std::int64_t, json>& bases) {
  static const Schema schema(json::parse(embedded::worker_run_schema_text));
  std::vector<Problem> problems = check_schema({"requests", run, {}}, schema);
  if (problems.empty()) {
    if (!bases.contains(run["base"].get<std::int64_t>()))
      problems.push_back({"/base", 0, concat("there is no base scene ", run["base"].dump()),
                          "send it before the first run that names it: "
                          "{\"base\": 1, \"scene\": {...}}"});
    for (const auto& [pointer, value] : run["changes"].items()) {
      try {
        const json::json_pointer checked(pointer);
      } catch (const json::exception&) {
        problems.push_back({"/changes", 0, concat("\"", pointer, "\" is not a JSON Pointer"),
                            "write for example \"/friction/angle\""});
      }
    }
  }
  for (Problem& problem : problems) problem.line = run.value("line", 0);
  if (!problems.empty()) throw InputError("requests", problems);
}

}  // namespace faultsim
