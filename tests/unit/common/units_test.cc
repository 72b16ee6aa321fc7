#include "simulator/common/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

double value(const std::string& text, Dimension dimension) {
  const ParsedQuantity parsed = parse_quantity(text, dimension);
  EXPECT_TRUE(parsed.ok) << parsed.what;
  return parsed.value;
}

std::string complaint(const std::string& text, Dimension dimension) {
  const ParsedQuantity parsed = parse_quantity(text, dimension);
  EXPECT_FALSE(parsed.ok);
  EXPECT_TRUE(std::isnan(parsed.value));
  return parsed.what + "; " + parsed.cure;
}

TEST(ParseQuantity, ConvertsWithOneRounding) {
  EXPECT_EQ(value("200 bar", Dimension::pressure), 2e7);
  EXPECT_EQ(value("200 bar", Dimension::pressure), value("20 MPa", Dimension::pressure));
  EXPECT_EQ(value("0.3 bar", Dimension::pressure), 30000.0);
  EXPECT_EQ(value("11 GPa", Dimension::pressure), 11e9);
  EXPECT_EQ(value("1.1 mm", Dimension::length), 0.0011);
  EXPECT_EQ(value("5 km", Dimension::length), 5000);
  for (const char* digits : {"1", "2.3", "7", "0.3", "1234.567", "9.9"}) {
    const std::string number = digits;
    EXPECT_EQ(value(number + " mm", Dimension::length), value(number + "e-3 m", Dimension::length));
    EXPECT_EQ(value(number + " um", Dimension::length), value(number + "e-6 m", Dimension::length));
    EXPECT_EQ(value(number + " bar", Dimension::pressure),
              value(number + "e5 Pa", Dimension::pressure));
    EXPECT_EQ(value(number + " GPa", Dimension::pressure),
              value(number + "e9 Pa", Dimension::pressure));
  }
  EXPECT_EQ(value("-1e-3 m", Dimension::length), -1e-3);
  EXPECT_EQ(value("2400 kg/m3", Dimension::density), 2400);
  EXPECT_EQ(value("2.4 g/cm3", Dimension::density), 2400);
  EXPECT_EQ(value("10 kPa/m", Dimension::pressure_gradient), 1e4);
  EXPECT_EQ(value("0.1 bar/m", Dimension::pressure_gradient), 1e4);
  EXPECT_EQ(value("1e17 Pa s", Dimension::viscosity), 1e17);
  EXPECT_EQ(value("3 m2", Dimension::area), 3);
  EXPECT_EQ(value("0.5", Dimension::number), 0.5);
}

TEST(ParseQuantity, KnowsDegreesByAllTheirNames) {
  const double right = std::acos(-1.0) / 2;
  EXPECT_DOUBLE_EQ(value("90 deg", Dimension::angle), right);
  EXPECT_EQ(value("90 deg", Dimension::angle), value("90 degree", Dimension::angle));
  EXPECT_EQ(value("90 deg", Dimension::angle), value("90 degrees", Dimension::angle));
  EXPECT_EQ(value("90 deg", Dimension::angle), value("90 \xC2\xB0", Dimension::angle));
  EXPECT_EQ(value("1 rad", Dimension::angle), 1);
  EXPECT_EQ(value("1 mrad", Dimension::angle), 1e-3);
  EXPECT_DOUBLE_EQ(value("0.25 turn", Dimension::angle), right);
  EXPECT_DOUBLE_EQ(value("5400 arcmin", Dimension::angle), right);
}

TEST(ParseQuantity, TakesNoBareRatioForAnAngle) {
  EXPECT_EQ(complaint("25 %", Dimension::angle),
            "\"25 %\" is not an angle; write for example \"25 deg\"");
  for (const char* ratio : {"1 1", "1 m/m", "3 mm/m", "5 ppm", "1 sr", "1 rad2", "1 deg/rad"}) {
    EXPECT_EQ(complaint(ratio, Dimension::angle).find("is not an angle"),
              std::string(ratio).size() + 3)
        << ratio;
  }
  complaint("1 Pa rad", Dimension::pressure);
  complaint("1 N m/rad", Dimension::moment);
  EXPECT_EQ(value("1 Pa deg/deg", Dimension::pressure), 1);
}

TEST(ParseQuantity, TakesAYearOf365AndAQuarterDays) {
  EXPECT_EQ(value("1 year", Dimension::time), 31557600);
  EXPECT_EQ(value("2 years", Dimension::time), 2 * 31557600.0);
  EXPECT_EQ(value("1 day", Dimension::time), 86400);
  EXPECT_EQ(value("1 h", Dimension::time), 3600);
}

TEST(ParseQuantity, SaysWhatIsWrongAndWhatWouldBeRight) {
  EXPECT_EQ(complaint("25", Dimension::angle), "\"25\" has no unit; did you mean \"25 deg\"?");
  EXPECT_EQ(complaint("25 m", Dimension::angle),
            "\"25 m\" is not an angle; write for example \"25 deg\"");
  EXPECT_EQ(
      complaint("25 furlogs", Dimension::length),
      "\"25 furlogs\" has the unknown unit \"furlogs\"; write a length, for example \"25 m\"");
  EXPECT_EQ(complaint("deg", Dimension::angle),
            "\"deg\" does not start with a number; write for example \"25 deg\"");
  EXPECT_EQ(complaint("", Dimension::length),
            "\"\" does not start with a number; write for example \"25 m\"");
  EXPECT_EQ(complaint("3 m", Dimension::number),
            "\"3 m\" has a unit but a plain number is wanted; write 3");
}

TEST(ParseQuantity, RefusesOffsetsOverflowNaNAndHexadecimals) {
  complaint("1e400 Pa", Dimension::pressure);
  complaint("1e305 GPa", Dimension::pressure);
  complaint("nan m", Dimension::length);
  complaint("inf m", Dimension::length);
  complaint("0x10 m", Dimension::length);
  complaint("1 degC", Dimension::time);
  complaint("1e400", Dimension::number);
}

TEST(ParseQuantity, HasNoNegativeZero) {
  EXPECT_FALSE(std::signbit(value("-0 m", Dimension::length)));
}

TEST(FromSi, IsTheInverse) {
  EXPECT_DOUBLE_EQ(from_si(2e7, Dimension::pressure, "bar"), 200);
  EXPECT_DOUBLE_EQ(from_si(31557600, Dimension::time, "year"), 1);
  EXPECT_DOUBLE_EQ(from_si(std::acos(-1.0), Dimension::angle, "deg"), 180);
}

TEST(Dimensions, AreListedOnceAndInOrder) {
  for (const DimensionInfo& one : dimensions()) {
    EXPECT_EQ(&info_of(one.dimension), &one);
    EXPECT_EQ(dimension_named(one.key), &one);
    const std::string usual = std::string("1 ") + one.usual;
    EXPECT_EQ(parse_quantity("1 " + std::string(one.si), one.dimension).value, 1) << one.key;
    EXPECT_TRUE(parse_quantity(usual, one.dimension).ok) << one.key;
  }
  EXPECT_EQ(dimension_named("colour"), nullptr);
}

TEST(ParseQuantity, KnowsAccelerations) {
  EXPECT_EQ(parse_quantity("9.81 m/s2", Dimension::acceleration).value, 9.81);
  EXPECT_EQ(parse_quantity("981 cm/s2", Dimension::acceleration).value, 9.81);
  EXPECT_EQ(parse_quantity("9.81 Pa/m", Dimension::acceleration).what,
            "\"9.81 Pa/m\" is not an acceleration");
}

}  // namespace
}  // namespace faultsim
