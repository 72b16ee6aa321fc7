#include "simulator/common/units.h"

#include <udunits2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// udunits' year is the tropical one, ours is 365.25 d; and it has no "deg". Both are spelled out
/// before udunits sees them.
std::string with_our_words(std::string_view unit) {
  std::string result;
  for (std::size_t i = 0; i < unit.size();) {
    if (std::isalpha(static_cast<unsigned char>(unit[i])) == 0) {
      result += unit[i++];
      continue;
    }
    std::size_t j = i;
    while (j < unit.size() && std::isalpha(static_cast<unsigned char>(unit[j])) != 0) ++j;
    const std::string word(unit.substr(i, j - i));
    const bool is_year = word == "year" || word == "years" || word == "yr" || word == "a";
    result += is_year ? "(31557600 s)" : word == "deg" ? "degree" : word;
    i = j;
  }
  return result;
}

/// The unit system of udunits2 with year = 365.25 d, read once per process.
class UnitSystem {
 public:
  static UnitSystem& instance() {
    static UnitSystem system;
    return system;
  }
  /// How to turn a number in a unit into SI: times or over a factor; nothing when the unit is of
  /// another dimension or has an offset.
  struct Answer {
    std::optional<double> factor;
    /// Factors of SI prefixes are powers of ten, of which udunits' double may be one bit off; taken
    /// exactly, "2.4 g/cm3" and "2400 kg/m3", "1 mm" and "0.001 m" are the same bits.
    long double times = 1;
    long double over = 1;
    bool known = false;
  };
  Answer answer(std::string_view unit, Dimension dimension) {
    const std::lock_guard lock(mutex_);
    auto& cache = caches_[dimension];
    if (const auto found = cache.find(unit); found != cache.end()) return found->second;
    return cache[std::string(unit)] = compute(with_our_words(unit), info_of(dimension).si);
  }

 private:
  struct FreeUnit {
    void operator()(ut_unit* unit) const { ut_free(unit); }
  };
  using Unit = std::unique_ptr<ut_unit, FreeUnit>;

  UnitSystem() {
    ut_set_error_message_handler(ut_ignore);
    system_ = ut_read_xml(nullptr);
    if (system_ == nullptr) throw ResourceError("the udunits2 unit database cannot be read");
  }
  Answer compute(const std::string& unit, const char* si) {
    Unit from(ut_parse(system_, unit.c_str(), UT_UTF8));
    Unit to(ut_parse(system_, si, UT_UTF8));
    if (!from) return {};
    Answer answer;
    answer.known = true;
    if (ut_are_convertible(from.get(), to.get()) == 0) return answer;
    cv_converter* converter = ut_get_converter(from.get(), to.get());
    if (converter == nullptr) return answer;
    const double factor = cv_convert_double(converter, 1.0);
    const bool has_offset = cv_convert_double(converter, 0.0) != 0.0;
    cv_free(converter);
    if (!has_offset && is_multiple(from.get(), factor, to.get())) take(factor, answer);
    return answer;
  }
  static void take(double factor, Answer& answer) {
    constexpr long kLargestExact = 27;  // 10^27 = 2^27 5^27 fits the 64 bits of a long double
    constexpr double kFewBits = 1e-14;
    const long exponent = std::lround(std::log10(std::abs(factor)));
    long double power = 1;
    for (long i = 0; i < std::min(std::abs(exponent), kLargestExact); ++i) power *= 10;
    const long double exact = exponent < 0 ? 1 / power : power;
    const bool is_power = std::abs(exponent) <= kLargestExact &&
                          std::abs(static_cast<long double>(factor) / exact - 1) < kFewBits;
    answer.factor = factor;
    if (is_power && exponent < 0) {
      answer.over = power;
    } else {
      answer.times = is_power ? power : static_cast<long double>(factor);
    }
  }
  /// True if one `from` is `factor` times `to`, radians counted: convertible is also "%" to "rad",
  /// as an angle has no dimension.
  static bool is_multiple(const ut_unit* from, double factor, const ut_unit* to) {
    const Unit scaled(ut_scale(factor, to));
    return scaled && ut_compare(from, scaled.get()) == 0;
  }

  ut_system* system_ = nullptr;
  std::mutex mutex_;
  std::map<Dimension, std::map<std::string, Answer, std::less<>>> caches_;
};

ParsedQuantity failed(std::string what, std::string cure) {
  return {std::numeric_limits<double>::quiet_NaN(), false, std::move(what), std::move(cure)};
}

std::string example(Dimension dimension, const std::string& number) {
  return "\"" + number + " " + usual_unit(dimension) + "\"";
}

}  // namespace

std::span<const DimensionInfo> dimensions() {
  using enum Dimension;
  static constexpr std::array<DimensionInfo, 14> kAll = {{
      {number, "number", "a plain number", "", "", "", {0, 0, 0, 0}},
      {length, "length", "a length", "m", "m", "_m", {1, 0, 0, 0}},
      {area, "area", "an area", "m2", "m2", "_m2", {2, 0, 0, 0}},
      {pressure, "pressure", "a pressure", "Pa", "bar", "_pa", {-1, 1, -2, 0}},
      {pressure_gradient,
       "pressure_gradient",
       "a pressure gradient",
       "Pa/m",
       "bar/m",
       "_pa_per_m",
       {-2, 1, -2, 0}},
      {density, "density", "a density", "kg/m3", "kg/m3", "_kg_per_m3", {-3, 1, 0, 0}},
      {angle, "angle", "an angle", "rad", "deg", "_rad", {0, 0, 0, 1}},
      {time, "time", "a time", "s", "year", "_s", {0, 0, 1, 0}},
      {viscosity, "viscosity", "a viscosity", "Pa s", "Pa s", "_pa_s", {-1, 1, -1, 0}},
      {moment, "moment", "a moment", "N m", "N m", "_nm", {2, 1, -2, 0}},
      {potency, "potency", "a volume", "m3", "m3", "_m3", {3, 0, 0, 0}},
      {acceleration, "acceleration", "an acceleration", "m/s2", "m/s2", "_m_per_s2", {1, 0, -2, 0}},
      {temperature, "temperature", "a temperature difference", "K", "K", "_k", {0, 0, 0, 0, 1}},
      {expansion, "expansion", "a thermal expansion", "1/K", "1/K", "_per_k", {0, 0, 0, 0, -1}},
  }};
  return kAll;
}

const DimensionInfo& info_of(Dimension dimension) {
  const DimensionInfo& info = dimensions()[static_cast<std::size_t>(dimension)];
  FAULTSIM_DEMAND(info.dimension == dimension, info.key);
  return info;
}

const DimensionInfo* dimension_named(std::string_view key) {
  const auto found = std::ranges::find(dimensions(), key, &DimensionInfo::key);
  return found == dimensions().end() ? nullptr : &*found;
}

ParsedQuantity parse_quantity(std::string_view text, Dimension dimension) {
  const std::string owned(text);
  const auto quoted = [&] { return "\"" + owned + "\""; };
  const char* begin = owned.c_str();
  char* end = nullptr;
  const bool starts_decimal =
      !owned.empty() && (std::isdigit(static_cast<unsigned char>(owned[0])) != 0 ||
                         owned[0] == '-' || owned[0] == '+' || owned[0] == '.');
  const bool hexadecimal = owned.find_first_of("xX") != std::string::npos;
  const long double number = starts_decimal && !hexadecimal ? std::strtold(begin, &end) : 0.0L;
  if (end == nullptr || end == begin) {
    return failed(quoted() + " does not start with a number",
                  dimension == Dimension::number ? "write a number"
                                                 : "write for example " + example(dimension, "25"));
  }
  const auto digits = [&] { return std::string(begin, end - begin); };
  std::string_view unit(end);
  unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
  if (dimension == Dimension::number && unit.empty()) {
    const auto value = static_cast<double>(number);
    if (!std::isfinite(value)) return failed(quoted() + " overflows", "write a finite number");
    return {value, true, "", ""};
  }
  if (dimension == Dimension::number) {
    return failed(quoted() + " has a unit but a plain number is wanted", "write " + digits());
  }
  if (unit.empty()) {
    return failed(quoted() + " has no unit", "did you mean " + example(dimension, digits()) + "?");
  }
  const auto answer = UnitSystem::instance().answer(unit, dimension);
  if (!answer.known) {
    return failed(
        concat(quoted(), " has the unknown unit \"", unit, "\""),
        concat("write ", info_of(dimension).noun, ", for example ", example(dimension, digits())));
  }
  if (!answer.factor) {
    return failed(concat(quoted(), " is not ", info_of(dimension).noun),
                  "write for example " + example(dimension, digits()));
  }
  const auto value = static_cast<double>(number * answer.times / answer.over);
  if (!std::isfinite(value)) return failed(quoted() + " overflows", "write a finite value");
  return {value == 0.0 ? 0.0 : value, true, "", ""};
}

double from_si(double value, Dimension dimension, const std::string& unit) {
  const auto answer = UnitSystem::instance().answer(unit, dimension);
  FAULTSIM_DEMAND(answer.factor.has_value(), "unit ", unit);
  return value / *answer.factor;
}

}  // namespace faultsim
