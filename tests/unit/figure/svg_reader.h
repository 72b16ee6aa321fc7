#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// An element of a drawing of ours.
struct SvgElement {
  std::string name, text;
  std::map<std::string, std::string> attributes;

  double number(const std::string& attribute) const {
    return std::strtod(attributes.at(attribute).c_str(), nullptr);
  }
  bool has(const std::string& attribute, const std::string& value) const {
    const auto found = attributes.find(attribute);
    return found != attributes.end() && found->second == value;
  }
  /// Of a polyline or polygon.
  std::vector<Point> points() const {
    std::vector<Point> all;
    const char* at = attributes.at("points").c_str();
    while (*at != '\0') {
      char* end = nullptr;
      const double x = std::strtod(at, &end);
      all.push_back({x, std::strtod(end + 1, &end)});
      at = end + (*end == ' ' ? 1 : 0);
    }
    return all;
  }
};

inline std::vector<SvgElement> elements_of(const std::string& svg) {
  static const std::regex kElement(R"(<(\w+)((?: [\w-]+="[^"]*")*)/?>([^<]*))");
  static const std::regex kAttribute(R"( ([\w-]+)="([^"]*)\")");
  std::vector<SvgElement> all;
  for (std::sregex_iterator one(svg.begin(), svg.end(), kElement), end; one != end; ++one) {
    SvgElement element{(*one)[1], (*one)[3], {}};
    const std::string attributes = (*one)[2];
    for (std::sregex_iterator a(attributes.begin(), attributes.end(), kAttribute); a != end; ++a)
      element.attributes[(*a)[1]] = (*a)[2];
    all.push_back(element);
  }
  return all;
}

/// Those of a name with an attribute of a value.
inline std::vector<SvgElement> elements_of(const std::string& svg, const std::string& name,
                                           const std::string& attribute, const std::string& value) {
  std::vector<SvgElement> all = elements_of(svg);
  std::erase_if(
      all, [&](const SvgElement& one) { return one.name != name || !one.has(attribute, value); });
  return all;
}

/// How far right and down an axis' numbers go per unit, as a reader sees it: from its labels.
struct ReadScale {
  double first = 0, per_px = 1;  ///< value at 0 px.
  double value(double px) const { return first + per_px * px; }
};

/// @param labels  px and number of the labels of one axis.
inline ReadScale scale_from(const std::vector<std::pair<double, double>>& labels) {
  if (labels.size() < 2) throw std::runtime_error("an axis with fewer than two labels");
  const auto [low, high] = std::minmax_element(labels.begin(), labels.end());
  const double per_px = (high->second - low->second) / (high->first - low->first);
  for (const auto& [px, value] : labels) {
    if (std::abs(low->second + per_px * (px - low->first) - value) > 0.02 * std::abs(per_px))
      throw std::runtime_error("labels are not even along their axis");
  }
  return {low->second - per_px * low->first, per_px};
}

/// A number as charts write it; false of other words.
inline bool read_number(std::string text, double& value) {
  for (std::size_t at; (at = text.find("−")) != std::string::npos;)
    text.replace(at, std::string("−").size(), "-");
  std::erase(text, ',');
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

/// Labels along x stand in the middle of their ticks, those along y end at them. Of several panels
/// that have labels the k-th, in the order of drawing.
inline ReadScale read_scale(const std::string& svg, bool along_x, std::size_t k = 0) {
  std::vector<std::vector<std::pair<double, double>>> axes(1);
  for (const SvgElement& one : elements_of(svg)) {
    if (one.name != "text") continue;
    double value = 0;
    const bool is_label = one.has("text-anchor", along_x ? "middle" : "end") &&
                          !one.attributes.contains("transform") && read_number(one.text, value);
    constexpr double kBaseLine = 4;  // below the middle of the letters
    if (is_label)
      axes.back().emplace_back(along_x ? one.number("x") : one.number("y") - kBaseLine, value);
    else
      axes.emplace_back();
  }
  std::erase_if(axes, [](const auto& one) { return one.size() < 2; });
  return scale_from(axes.at(k));
}

}  // namespace faultsim::figure
