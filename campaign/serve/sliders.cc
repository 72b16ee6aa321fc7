#include "campaign/serve/sliders.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep::serve {
namespace {

using faultsim::ParameterInfo;

/// "0.3 MPa" in SI and its unit; none where it is no quantity ("of the tier").
struct Given {
  double si = 0;
  std::string unit;
};
std::optional<Given> given_in(const std::string& text, Dimension dimension) {
  const faultsim::ParsedQuantity parsed = faultsim::parse_quantity(text, dimension);
  if (!parsed.ok) return std::nullopt;
  const std::size_t blank = text.find(' ');
  return Given{parsed.value, blank == std::string::npos ? "" : text.substr(blank + 1)};
}

/// How far a slider goes about a value that says nothing of its own size, SI.
double usual_reach(Dimension dimension) {
  constexpr double kPressure = 5e6, kAngle = 0.2, kLength = 100, kNumber = 0.2;
  switch (dimension) {
    case Dimension::pressure:
      return kPressure;
    case Dimension::angle:
      return kAngle;
    case Dimension::length:
      return kLength;
    case Dimension::time:
      return kYear;
    default:
      return kNumber;
  }
}

/// The ends of "[0 deg, 80 deg]"; none where it is not of this kind.
std::optional<std::pair<double, double>> ends_of(const std::string& range, Dimension dimension) {
  const std::size_t comma = range.find(", ");
  if (range.size() < 2 || range.front() != '[' || comma == std::string::npos) return std::nullopt;
  const auto from = given_in(range.substr(1, comma - 1), dimension);
  const auto to = given_in(range.substr(comma + 2, range.size() - comma - 3), dimension);
  if (!from || !to) return std::nullopt;
  return std::pair(from->si, to->si);
}

/// About the value, within what a scene may say.
std::optional<std::pair<double, double>> range_about(double value, const ParameterInfo& info) {
  const auto ends = ends_of(info.range, info.dimension);
  if (!ends) return std::nullopt;
  constexpr double kWide = 8;
  const double reach = std::max(std::abs(value) / 2, usual_reach(info.dimension));
  if (ends->second - ends->first <= kWide * reach) return ends;
  return std::pair(std::max(ends->first, value - reach), std::min(ends->second, value + reach));
}

/// Parameters of the case's scene by pointer.
class SceneParameters {
 public:
  explicit SceneParameters(const json& scene)
      : document_{"case", scene, {}}, infos_(faultsim::parameters(document_)) {
    const json::json_pointer over("/numerics/surface/over");
    if (!scene.contains(over)) return;
    for (const json& one : scene.at(over)) {
      on_surface_.push_back(
          faultsim::resolve_parameter(document_, one.at("parameter").get<std::string>()));
    }
  }
  const std::vector<ParameterInfo>& all() const { return infos_; }
  const ParameterInfo* find(const std::string& pointer) const {
    const auto found = std::ranges::find(infos_, pointer, &ParameterInfo::pointer);
    return found == infos_.end() ? nullptr : &*found;
  }
  bool keeps_operator(const ParameterInfo& info) const {
    return !info.new_family || contains(on_surface_, info.pointer);
  }

 private:
  faultsim::JsonDocument document_;
  std::vector<ParameterInfo> infos_;
  std::vector<std::string> on_surface_;
};

/// A slider of numbers at the scene's present value; none where that is none, or where no range is
/// known. @param ends  SI; none = about the value.
std::optional<Slider> slider_of(const ParameterInfo& info,
                                std::optional<std::pair<double, double>> ends) {
  const auto given = info.is_text ? std::nullopt : given_in(info.value, info.dimension);
  if (!given) return std::nullopt;
  if (!ends) ends = range_about(given->si, info);
  if (!ends || !(ends->first < ends->second)) return std::nullopt;
  Slider slider;
  slider.unit = given->unit;
  const auto shown = [&](double si) {  // 30, where conversions leave 29.999999999999996
    return std::strtod(
        formatted("%.10g", faultsim::from_si(si, info.dimension, slider.unit)).c_str(), nullptr);
  };
  slider.value = shown(given->si);
  slider.from = shown(std::min(ends->first, given->si));
  slider.to = shown(std::max(ends->second, given->si));
  slider.meaning = info.description;
  return slider;
}

/// Where all pointers of each choice get the choice's own number: what a slider could set.
std::vector<std::string> common_pointers(const json& choices) {
  std::vector<std::string> pointers;
  for (const json& choice : choices) {
    std::vector<std::string> here;
    for (const auto& [pointer, value] : choice.at("changes").items()) {
      const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
      if (text != choice.at("text").get<std::string>()) return {};
      here.push_back(pointer);
    }
    if (!pointers.empty() && here != pointers) return {};
    pointers = here;
  }
  return pointers;
}

/// Smallest and largest number among the choices; none where one is words.
std::optional<std::pair<double, double>> ends_of_choices(const json& choices) {
  double from = INFINITY, to = -INFINITY;
  for (const json& choice : choices) {
    if (!choice.contains("si") || !choice.at("si").is_number()) return std::nullopt;
    from = std::min(from, choice.at("si").get<double>());
    to = std::max(to, choice.at("si").get<double>());
  }
  if (!(from <= to)) return std::nullopt;
  return std::pair(from, to);
}

/// A parameter of the spec, as its resolved copy has it.
std::optional<Slider> of_spec(const json& parameter, const SceneParameters& scene) {
  std::vector<std::string> pointers;
  std::optional<std::pair<double, double>> ends;
  std::vector<std::pair<std::string, ordered_json>> choices;
  bool is_log = false;
  if (parameter.contains("range")) {
    const json& range = parameter.at("range");
    pointers = range.at("pointers").get<std::vector<std::string>>();
    ends = std::pair(range.at("from_si").get<double>(), range.at("to_si").get<double>());
    is_log = range.value("spacing", "") == "log" || range.value("distribution", "") == "log-normal";
  } else {
    const json values = parameter.value("choices", json::array());
    pointers = common_pointers(values);
    ends = ends_of_choices(values);
    for (const json& one : values)
      choices.emplace_back(one.at("text").get<std::string>(), one.at("changes"));
  }
  std::optional<Slider> slider;
  bool keeps = true;
  for (const std::string& pointer : pointers) {
    const ParameterInfo* info = scene.find(pointer);
    if (info == nullptr) continue;
    keeps = keeps && scene.keeps_operator(*info);
    if (!slider) slider = slider_of(*info, ends);
  }
  if (!slider && choices.empty()) return std::nullopt;
  if (!slider) {
    slider = Slider();
    slider->choices = std::move(choices);
    for (const auto& [text, changes] : slider->choices)
      for (const auto& [pointer, value] : changes.items())
        if (const ParameterInfo* info = scene.find(pointer))
          keeps = keeps && scene.keeps_operator(*info);
  }
  slider->name = parameter_label(parameter.at("name").get<std::string>());
  slider->pointers = std::move(pointers);
  slider->is_log = is_log && slider->from > 0;
  slider->of_campaign = true;
  slider->keeps_operator = keeps;
  return slider;
}

bool is_of_model(const ParameterInfo& info) {
  return !info.alias.empty() && !info.pointer.starts_with("/numerics/") &&
         !info.pointer.starts_with("/mesh/") && !info.pointer.ends_with("/steps");
}

}  // namespace

std::vector<Slider> sliders_of(const json& scene, const std::string& resolved_spec) {
  const SceneParameters of_scene(scene);
  std::vector<Slider> sliders;
  std::vector<std::string> names, taken;
  const json spec = json::parse(resolved_spec);
  for (const json& group : spec.value("groups", json::array())) {
    for (const json& parameter : group.value("parameters", json::array())) {
      if (contains(names, parameter.at("name").get<std::string>())) continue;
      names.push_back(parameter.at("name").get<std::string>());
      std::optional<Slider> slider = of_spec(parameter, of_scene);
      if (!slider) continue;
      append(taken, slider->pointers);
      sliders.push_back(std::move(*slider));
    }
  }
  for (const ParameterInfo& info : of_scene.all()) {
    if (!is_of_model(info) || !of_scene.keeps_operator(info) || contains(taken, info.pointer))
      continue;
    std::optional<Slider> slider = slider_of(info, std::nullopt);
    if (!slider) continue;
    slider->name = parameter_label(info.alias);
    slider->pointers = {info.pointer};
    sliders.push_back(std::move(*slider));
  }
  return sliders;
}

namespace {

/// A number, or a text that begins like one: where a scene wants a quantity it reads no file.
bool looks_like_number(const json& value) {
  if (value.is_number()) return true;
  const std::string text = value.is_string() ? value.get<std::string>() : std::string();
  return !text.empty() && std::string_view("0123456789+-.").find(text[0]) != std::string::npos;
}

bool lets_change(const Slider& slider, const std::string& pointer, const json& value) {
  if (slider.choices.empty()) return contains(slider.pointers, pointer) && looks_like_number(value);
  return std::ranges::any_of(slider.choices, [&](const auto& choice) {
    return choice.second.contains(pointer) && json(choice.second.at(pointer)) == value;
  });
}

}  // namespace

void require_allowed(const std::vector<Slider>& sliders, const json& changes) {
  for (const auto& [pointer, value] : changes.items()) {
    const auto allows = [&, &p = pointer, &v = value](const Slider& one) {
      return lets_change(one, p, v);
    };
    if (std::ranges::none_of(sliders, allows)) {
      throw HttpError(400, "changes",
                      concat("\"", pointer, "\" cannot be changed to ", value.dump(), " here"),
                      "GET .../parameters lists what can");
    }
  }
}

ordered_json to_json(const std::vector<Slider>& sliders) {
  ordered_json list = ordered_json::array();
  for (const Slider& one : sliders) {
    ordered_json entry = {{"name", one.name},
                          {"of_campaign", one.of_campaign},
                          {"keeps_operator", one.keeps_operator},
                          {"meaning", one.meaning}};
    if (one.choices.empty()) {
      entry.update({{"pointers", one.pointers},
                    {"unit", one.unit},
                    {"value", one.value},
                    {"from", one.from},
                    {"to", one.to},
                    {"log", one.is_log}});
    } else {
      ordered_json choices = ordered_json::array();
      for (const auto& [text, changes] : one.choices)
        choices.push_back({{"text", text}, {"changes", changes}});
      entry["choices"] = std::move(choices);
    }
    list.push_back(std::move(entry));
  }
  return {{"parameters", std::move(list)}};
}

}  // namespace faultsweep::serve
