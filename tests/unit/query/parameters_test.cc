// Names and units of a campaign's parameters, as tables and charts have them.
#include <gtest/gtest.h>

#include "campaign/query/parameters.h"

namespace faultsweep {
namespace {

CaseParameter value_of(const char* text, std::optional<double> si) { return {0, si, text}; }

TEST(CommonUnit, IsThatOfAllValuesOrNone) {
  CommonUnit one;
  EXPECT_FALSE(one.unit());
  one.add(value_of("0.3 MPa", 3e5));
  EXPECT_EQ(one.unit(), "MPa");
  one.add(value_of("0.6 MPa", 6e5));
  EXPECT_EQ(one.unit(), "MPa");
  one.add(value_of("6 bar", 6e5));
  EXPECT_FALSE(one.unit());
  one.add(value_of("7 bar", 7e5));
  EXPECT_FALSE(one.unit()) << "whatever comes next";
  CommonUnit plain;
  plain.add(value_of("0.4", 0.4));
  EXPECT_EQ(plain.unit(), "");
  CommonUnit words;
  words.add(value_of("-100 bar", -1e7));
  words.add(value_of("mean of both", std::nullopt));
  EXPECT_FALSE(words.unit());
}

TEST(ParameterLabel, IsForPeople) {
  EXPECT_EQ(parameter_label("friction_angle"), "friction angle");
  EXPECT_EQ(parameter_label("/pressure_field/file"), "pressure field: file");
  EXPECT_EQ(parameter_label(""), "");
}

}  // namespace
}  // namespace faultsweep
