#pragma once

#include <array>
#include <numbers>
#include <span>
#include <string>
#include <string_view>

namespace faultsim {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< rad

/// The physical dimensions that occur in scenes, campaign specs and expressions.
enum class Dimension {
  number,             ///< no unit allowed
  length,             ///< m
  area,               ///< m2
  pressure,           ///< Pa (stress, modulus, cohesion, traction)
  pressure_gradient,  ///< Pa/m
  density,            ///< kg/m3
  angle,              ///< rad
  time,               ///< s (a "year" is 365.25 d here, not udunits' tropical year)
  viscosity,          ///< Pa s
  moment,             ///< N m
  potency,            ///< m3
  acceleration,       ///< m/s2
  temperature,        ///< K, of a difference
  expansion,          ///< 1/K
};

/// All there is to say about a dimension. A new one is a value above and a line in units.cc.
struct DimensionInfo {
  Dimension dimension;
  const char* key;            ///< in schemas and stores: "pressure_gradient"
  const char* noun;           ///< in messages: "a pressure gradient"
  const char* si;             ///< unit as udunits writes it: "Pa/m"; "" for number
  const char* usual;          ///< unit to suggest: "bar/m"
  const char* suffix;         ///< of columns in SI: "_pa_per_m"
  std::array<int, 5> powers;  ///< of length, mass, time, angle, temperature
};
/// In the order of Dimension.
std::span<const DimensionInfo> dimensions();
const DimensionInfo& info_of(Dimension dimension);
/// By DimensionInfo::key; nullptr if there is none.
const DimensionInfo* dimension_named(std::string_view key);

inline const char* si_unit(Dimension dimension) { return info_of(dimension).si; }
inline const char* usual_unit(Dimension dimension) { return info_of(dimension).usual; }

/// The outcome of reading one quantity; on failure value is NaN and what/cure say why.
struct ParsedQuantity {
  double value;  ///< SI.
  bool ok = false;
  std::string what;  ///< "\"25\" has no unit"
  std::string cure;  ///< "did you mean \"25 deg\"?"
};

/// Reads "200 bar", "11 GPa", "30 deg", "-1e-3 m" (decimal number, blank, udunits unit).
///
/// The number's decimal text times the unit factor is formed in long double and rounded once, so
/// that "200 bar" and "20 MPa" are the same bits. Units with an offset (degC) are refused, and so
/// are units that differ by radians: "25 %" is not an angle, "1 Pa rad" no pressure. A bare number
/// is right only for Dimension::number. Overflow and NaN are refused.
ParsedQuantity parse_quantity(std::string_view text, Dimension dimension);

/// value (SI) in the given unit, for printing: from_si(2e7, Dimension::pressure, "bar") = 200.
double from_si(double value, Dimension dimension, const std::string& unit);

}  // namespace faultsim
