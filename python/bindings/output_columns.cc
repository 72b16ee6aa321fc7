#include "python/bindings/output_columns.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "simulator/common/near_miss.h"
#include "simulator/common/ranges.h"
#include "simulator/result/result_fields.h"

namespace faultsim::python {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view kMargin = "pressure_margin";

template <typename T>
double number(const T& value) {
  if constexpr (std::is_arithmetic_v<T>) return static_cast<double>(value);
  return kNoValue;
}
template <typename T>
double number(const std::optional<T>& value) {
  return value ? number(*value) : kNoValue;
}

template <typename T>
inline constexpr bool is_number = std::is_arithmetic_v<T>;
template <typename T>
inline constexpr bool is_number<std::optional<T>> = std::is_arithmetic_v<T>;

bool is_called(const Field& field, std::string_view name) {
  return field.metric() == name || field.synonym == name || field.key == name;
}

template <typename Struct>
double value_of(const Struct& of, std::string_view name) {
  double value = kNoValue;
  bool is_found = false;
  for_each_field(of, [&](const Field& field, const auto& member) {
    if constexpr (is_number<std::remove_cvref_t<decltype(member)>>) {
      if (is_found || !is_called(field, name)) return;
      value = number(member);
      is_found = true;
    }
  });
  return value;
}

template <typename Struct>
std::vector<std::string> names_of() {
  std::vector<std::string> names;
  const Struct none;
  for_each_field(none, [&](const Field& field, const auto& member) {
    if constexpr (is_number<std::remove_cvref_t<decltype(member)>>)
      names.emplace_back(field.metric());
  });
  return names;
}

template <typename Struct>
bool has(std::string_view name) {
  const Struct none;
  bool is_there = false;
  for_each_field(none, [&](const Field& field, const auto& member) {
    if constexpr (is_number<std::remove_cvref_t<decltype(member)>>)
      is_there = is_there || is_called(field, name);
  });
  return is_there;
}

template <typename Struct>
const Struct* named(const std::vector<Struct>& all, std::string Struct::*name,
                    const std::string& wanted) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Struct& one) { return one.*name == wanted; });
  return found == all.end() ? nullptr : &*found;
}

void require(const std::string& output, const char* kind, const std::string& name,
             const std::vector<std::string>& known) {
  if (!name.empty() && !contains(known, name))
    throw InputError("outputs", concat("\"", output, "\": there is no ", kind, " \"", name, "\""),
                     suggest(name, known));
}

}  // namespace

OutputColumn::OutputColumn(const std::string& name, const std::vector<std::string>& stages,
                           const std::vector<std::string>& faults)
    : measure_(name) {
  constexpr std::string_view kIn = " in ";
  if (const std::size_t in = measure_.find(kIn); in != std::string::npos) {
    stage_ = measure_.substr(in + kIn.size());
    measure_.erase(in);
  }
  if (const std::size_t dot = measure_.rfind('.'); dot != std::string::npos) {
    fault_ = measure_.substr(0, dot);
    measure_.erase(0, dot + 1);
  }
  require(name, "fault", fault_, faults);
  require(name, "stage", stage_, stages);
  const bool is_of_case = fault_.empty() && stage_.empty() && measure_ == kMargin;
  if (is_of_case ||
      (fault_.empty() ? has<StageMetrics>(measure_) : has<FaultStageMetrics>(measure_)))
    return;
  throw InputError(
      "outputs", concat("there is no output \"", name, "\""),
      suggest(measure_, fault_.empty() ? names_of_case() : names_of<FaultStageMetrics>()));
}

double OutputColumn::of(const CaseResult& result) const {
  if (measure_ == kMargin) return result.pressure_margin;
  const StageMetrics* stage =
      stage_.empty() ? &result.whole : named(result.stages, &StageMetrics::stage, stage_);
  if (stage == nullptr) return kNoValue;  // the history ended before
  if (fault_.empty()) return value_of(*stage, measure_);
  const FaultStageMetrics* fault = named(stage->faults, &FaultStageMetrics::fault, fault_);
  return fault == nullptr ? kNoValue : value_of(*fault, measure_);
}

std::vector<std::string> OutputColumn::names_of_case() {
  std::vector<std::string> names = names_of<StageMetrics>();
  names.emplace_back(kMargin);
  return names;
}

}  // namespace faultsim::python
