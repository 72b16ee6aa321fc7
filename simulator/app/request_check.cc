#include "simulator/app/request_check.h"

#include "simulator/common/errors.h"
#include "simulator/common/printable.h"

namespace faultsim {

using nlohmann::json;

namespace {

constexpr const char* kForms =
    "write {\"base\": 1, \"scene\": {...}}, {\"run\": 17, \"base\": 1, \"changes\": {...}} or "
    "{\"cancel\": 17}, each in one line";

/// A value as a message shows it.
std::string shown(const json& value) {
  constexpr std::size_t kMost = 60;
  if (value.is_structured()) return value.is_array() ? "a list" : "an object";
  return shortened(value.dump(-1, ' ', false, json::error_handler_t::replace), kMost);
}

class RunCheck {
 public:
  explicit RunCheck(const json& run) : run_(run), line_(run.value("line", 0)) {}

  void check(const std::map<std::int64_t, json>& bases) {
    check_base(bases);
    check_changes();
    for (const char* key : {"source", "identity"}) {
      if (run_.contains(key) && !run_[key].is_string())
        problem(concat("/", key), concat(shown(run_[key]), " is not a text"), "write a string");
    }
    if (run_.contains("fields")) check_fields(run_["fields"]);
    if (!problems_.empty()) throw InputError("requests", problems_);
  }

 private:
  void problem(const std::string& pointer, const std::string& what, const std::string& cure) {
    problems_.push_back({pointer, line_, what, cure});
  }

  void check_base(const std::map<std::int64_t, json>& bases) {
    if (!run_.contains("base") || !run_["base"].is_number_integer()) {
      problem("/base", "the number of the base scene is missing", "write for example \"base\": 1");
    } else if (!bases.contains(run_["base"].get<std::int64_t>())) {
      problem("/base", concat("there is no base scene ", shown(run_["base"])),
              "send it before the first run that names it: {\"base\": 1, \"scene\": {...}}");
    }
  }

  void check_changes() {
    if (!run_.contains("changes") || !run_["changes"].is_object())
      return problem("/changes", "the values of the case are missing",
                     "write {\"/friction/angle\": \"25 deg\"}, or {} for the base scene itself");
    for (const auto& [pointer, value] : run_["changes"].items()) {
      try {
        const json::json_pointer checked(pointer);
      } catch (const json::exception&) {
        problem("/changes", concat("\"", pointer, "\" is not a JSON Pointer"),
                "write for example \"/friction/angle\"");
      }
    }
  }

  void check_fields(const json& fields) {
    if (!fields.is_object())
      return problem("/fields", concat(shown(fields), " is not an object"),
                     "write {\"steps\": \"stages\"}");
    const json steps = fields.value("steps", json());
    if (steps != "stages" && steps != "all")
      problem("/fields/steps", concat(shown(steps), " is not a choice of steps"),
              "write \"stages\" or \"all\"");
    if (fields.contains("folder") && !fields["folder"].is_string())
      problem("/fields/folder", concat(shown(fields["folder"]), " is not a path"),
              "write a string, or leave it out");
  }

  const json& run_;
  int line_;
  std::vector<Problem> problems_;
};

}  // namespace

json request_of_line(const std::string& text, int number) {
  const auto refuse = [&](const std::string& what) {
    throw InputError("requests", {{"", number, what, kForms}});
  };
  json request = json::parse(text, nullptr, false);
  if (request.is_discarded()) refuse("the line is not JSON");
  if (!request.is_object()) refuse(concat(shown(request), " is not a request"));
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
  RunCheck(run).check(bases);
}

}  // namespace faultsim
