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

struct DimensionInfo {
  const char* si;
  const char* usual;
  const char* name;
};

DimensionInfo info(Dimension dimension) {
  switch (dimension) {
    case Dimension::number:
      return {"", "", "a number"};
    case Dimension::length:
      return {"m", "m", "a length"};
    case Dimension::area:
      return {"m2", "m2", "an area"};
    case Dimension::pressure:
      return {"Pa", "bar", "a pressure"};
    case Dimension::pressure_gradient:
      return {"Pa/m", "bar/m", "a pressure gradient"};
    case Dimension::density:
      return {"kg/m3", "kg/m3", "a density"};
    case Dimension::angle:
      return {"rad", "deg", "an angle"};
    case Dimension::time:
      return {"s", "year", "a time"};
    case Dimension::viscosity:
      return {"Pa s", "Pa s", "a viscosity"};
    case Dimension::moment:
      return {"N m", "N m", "a moment"};
    case Dimension::potency:
      return {"m3", "m3", "a potency"};
  }
  throw_internal("known dimension", "", __FILE__, __LINE__);
}

/// The unit system of udunits2 with year = 365.25 d, read once per process.
class UnitSystem {
 public:
  static UnitSystem& instance() {
    static UnitSystem system;
    return system;
  }
  /// The factor from unit to the SI unit; nothing when unknown, of another dimension or offset.
  struct Answer {
    std::optional<double> factor;
    bool known = false;
  };
  Answer factor(const std::string& unit, const char* si) {
    const std::lock_guard lock(mutex_);
    const auto key = std::make_pair(unit, std::string(si));
    if (auto found = cache_.find(key); found != cache_.end()) return found->second;
    return cache_[key] = compute(unit, si);
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
    Answer answer{std::nullopt, true};
    if (ut_are_convertible(from.get(), to.get()) == 0) return answer;
    cv_converter* converter = ut_get_converter(from.get(), to.get());
    if (converter == nullptr) return answer;
    const double factor = cv_convert_double(converter, 1.0);
    const bool has_offset = cv_convert_double(converter, 0.0) != 0.0;
    cv_free(converter);
    if (!has_offset && is_multiple(from.get(), factor, to.get())) answer.factor = factor;
    return answer;
  }
  /// True if one `from` is `factor` times `to`, radians counted: convertible is also "%" to "rad",
  /// as an angle has no dimension.
  static bool is_multiple(const ut_unit* from, double factor, const ut_unit* to) {
    const Unit scaled(ut_scale(factor, to));
    return scaled && ut_compare(from, scaled.get()) == 0;
  }

  ut_system* system_ = nullptr;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Answer> cache_;
};

/// udunits' year is the tropical one, ours is 365.25 d; and it has no "deg". Both are spelled out
/// before udunits sees them.
std::string with_our_words(const std::string& unit) {
  std::string result;
  for (std::size_t i = 0; i < unit.size();) {
    if (std::isalpha(static_cast<unsigned char>(unit[i])) == 0) {
      result += unit[i++];
      continue;
    }
    std::size_t j = i;
    while (j < unit.size() && std::isalpha(static_cast<unsigned char>(unit[j])) != 0) ++j;
    const std::string word = unit.substr(i, j - i);
    const bool is_year = word == "year" || word == "years" || word == "yr" || word == "a";
    result += is_year ? "(31557600 s)" : word == "deg" ? "degree" : word;
    i = j;
  }
  return result;
}

/// number times factor. Factors of SI prefixes are powers of ten, of which udunits' double may be
/// one bit off; taken exactly, "2.4 g/cm3" and "2400 kg/m3", "1 mm" and "0.001 m" are the same
/// bits.
long double times(long double number, double factor) {
  constexpr long kLargestExact = 27;  // 10^27 = 2^27 5^27 fits the 64 bits of a long double
  constexpr double kFewBits = 1e-14;
  const long exponent = std::lround(std::log10(std::abs(factor)));
  long double power = 1;
  for (long i = 0; i < std::min(std::abs(exponent), kLargestExact); ++i) power *= 10;
  const long double exact = exponent < 0 ? 1 / power : power;
  const bool is_power = std::abs(exponent) <= kLargestExact &&
                        std::abs(static_cast<long double>(factor) / exact - 1) < kFewBits;
  if (!is_power) return number * static_cast<long double>(factor);
  return exponent < 0 ? number / power : number * power;
}

ParsedQuantity failed(std::string what, std::string cure) {
  return {std::numeric_limits<double>::quiet_NaN(), false, std::move(what), std::move(cure)};
}

std::string example(Dimension dimension, const std::string& number) {
  return "\"" + number + " " + info(dimension).usual + "\"";
}

}  // namespace

const char* si_unit(Dimension dimension) { return info(dimension).si; }
const char* usual_unit(Dimension dimension) { return info(dimension).usual; }

ParsedQuantity parse_quantity(std::string_view text, Dimension dimension) {
  const std::string owned(text);
  const std::string quoted = "\"" + owned + "\"";
  const char* begin = owned.c_str();
  char* end = nullptr;
  const bool starts_decimal =
      !owned.empty() && (std::isdigit(static_cast<unsigned char>(owned[0])) != 0 ||
                         owned[0] == '-' || owned[0] == '+' || owned[0] == '.');
  const bool hexadecimal = owned.find_first_of("xX") != std::string::npos;
  const long double number = starts_decimal && !hexadecimal ? std::strtold(begin, &end) : 0.0L;
  const std::string fallback = dimension == Dimension::number
                                   ? "write a number"
                                   : "write for example " + example(dimension, "25");
  if (end == nullptr || end == begin) {
    return failed(quoted + " does not start with a number", fallback);
  }
  const std::string digits(begin, static_cast<std::size_t>(end - begin));
  std::string unit(end);
  unit.erase(0, unit.find_first_not_of(' ') == std::string::npos ? unit.size()
                                                                 : unit.find_first_not_of(' '));
  if (dimension == Dimension::number && unit.empty()) {
    const auto value = static_cast<double>(number);
    if (!std::isfinite(value)) return failed(quoted + " overflows", "write a finite number");
    return {value, true, "", ""};
  }
  if (dimension == Dimension::number) {
    return failed(quoted + " has a unit but a plain number is wanted", "write " + digits);
  }
  if (unit.empty()) {
    return failed(quoted + " has no unit", "did you mean " + example(dimension, digits) + "?");
  }
  const auto answer = UnitSystem::instance().factor(with_our_words(unit), info(dimension).si);
  if (!answer.known) {
    return failed(quoted + " has the unknown unit \"" + unit + "\"",
                  "write " + std::string(info(dimension).name) + ", for example " +
                      example(dimension, digits));
  }
  if (!answer.factor) {
    return failed(quoted + " is not " + info(dimension).name,
                  "write for example " + example(dimension, digits));
  }
  const auto value = static_cast<double>(times(number, *answer.factor));
  if (!std::isfinite(value)) return failed(quoted + " overflows", "write a finite value");
  return {value == 0.0 ? 0.0 : value, true, "", ""};
}

double from_si(double value, Dimension dimension, const std::string& unit) {
  const auto answer = UnitSystem::instance().factor(with_our_words(unit), info(dimension).si);
  FAULTSIM_DEMAND(answer.factor.has_value(), "unit ", unit);
  return value / *answer.factor;
}

}  // namespace faultsim
