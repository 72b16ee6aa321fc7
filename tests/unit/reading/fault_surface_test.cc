#include "simulator/reading/fault_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using horizons::DrawnSurface;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kSurface = R"(GOCAD TSurf 1
HEADER {
*solid*color: 1 0 0
name:Main fault
}
GOCAD_ORIGINAL_COORDINATE_SYSTEM
NAME Default
AXIS_NAME "X" "Y" "Z"
AXIS_UNIT "m" "m" "m"
ZPOSITIVE Depth
END_ORIGINAL_COORDINATE_SYSTEM
PROPERTIES slip
# a comment
TFACE
PVRTX 1 0 -100 1500 0.5
PVRTX 2 0 100 1500 0.5
VRTX 3 50 -100 2500
TRGL 1 2 3
TFACE
ATOM 4 2
VRTX 5 50 -100 2500
VRTX 6 50 100 2500
TRGL 4 6 5
BSTONE 1
END
)";

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string said(const std::string& text) {
  try {
    parse_fault_surface(text, "F.ts", "F");
  } catch (const InputError& error) {
    std::string all;
    for (const Problem& one : error.problems())
      all += concat(one.line, ": ", one.what, "; ", one.cure, "\n");
    return all;
  }
  return "";
}

TEST(FaultSurface, ReadsATSurf) {
  const DrawnSurface surface = parse_fault_surface(kSurface, "F.ts", "F");
  ASSERT_EQ(surface.points.size(), 4u) << "points of both patches at one place are one";
  EXPECT_EQ(surface.points[0], Vector3d(0, -100, -1500));
  EXPECT_EQ(surface.points[3], Vector3d(50, 100, -2500));
  ASSERT_EQ(surface.triangles.size(), 2u);
  EXPECT_THAT(surface.triangles[0], ElementsAre(0, 1, 2));
  EXPECT_THAT(surface.triangles[1], ElementsAre(1, 3, 2));
  EXPECT_TRUE(surface.sticks.empty());
}

TEST(FaultSurface, ZIsUpwardsUnlessItSaysDepth) {
  const std::string up = changed(kSurface, "ZPOSITIVE Depth", "ZPOSITIVE Elevation");
  EXPECT_EQ(parse_fault_surface(up, "F.ts", "F").points[0].z(), 1500);
  const std::string loud = changed(kSurface, "ZPOSITIVE Depth", "ZPOSITIVE DEPTH");
  EXPECT_EQ(parse_fault_surface(loud, "F.ts", "F").points[0].z(), -1500);
  EXPECT_THAT(said(changed(kSurface, "ZPOSITIVE Depth", "ZPOSITIVE Down")),
              HasSubstr("10: the sense \"Down\" of ZPOSITIVE is not known; write Depth or "));
  const std::string silent = changed(kSurface, "ZPOSITIVE Depth\n", "");
  EXPECT_EQ(parse_fault_surface(silent, "F.ts", "F").points[0].z(), 1500);
}

TEST(FaultSurface, FeetAreMetres) {
  const std::string feet = changed(kSurface, R"("m" "m" "m")", R"("m" "m" "ft")");
  const Vector3d at = parse_fault_surface(feet, "F.ts", "F").points[0];
  EXPECT_DOUBLE_EQ(at.z(), -1500 * 0.3048);
  EXPECT_EQ(at.y(), -100);
  EXPECT_THAT(said(changed(kSurface, R"("m" "m" "m")", R"("m" "m" "s")")),
              HasSubstr("9: the unit \"s\" is not known; write m or ft"));
}

TEST(FaultSurface, OfSeveralTheOneOfTheFaultsNameIsTaken) {
  const std::string other = changed(kSurface, "Main fault", "F");
  const std::string both = kSurface + changed(other, "0 -100 1500", "7 -100 1500");
  EXPECT_EQ(parse_fault_surface(both, "all.ts", "F").points[0].x(), 7);
  EXPECT_EQ(parse_fault_surface(both, "all.ts", "Main fault").points[0].x(), 0);
  EXPECT_THAT(said(other + other), HasSubstr("has several surfaces named \"F\"; join them"));
  try {
    parse_fault_surface(both, "all.ts", "G");
    ADD_FAILURE() << "there is no G";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("has 2 surfaces (\"Main fault\", \"F\"), none of them named G"));
  }
}

TEST(FaultSurface, TabsThatTravelledAreSemicolons) {
  std::string text = kSurface;
  for (char& c : text) c = c == ' ' ? ';' : c;
  EXPECT_EQ(parse_fault_surface(changed(text, "GOCAD;TSurf", "GOCAD TSurf"), "F.ts", "F").points[3],
            Vector3d(50, 100, -2500));
}

TEST(FaultSurface, AllThatIsWrongWithATSurfIsSaidByLine) {
  EXPECT_EQ(said("GOCAD PLine 1\n"), "1: is not a TSurf; write the fault as a GOCAD TSurf\n");
  std::string bad = changed(kSurface, "PVRTX 2 0 100 1500", "PVRTX 2 0 east 1500");
  bad = changed(bad, "ATOM 4 2", "ATOM 4 9");
  bad = changed(bad, "VRTX 5 50", "VRTX 3 50");
  bad = changed(bad, "TRGL 4 6 5", "TRGL 4 6 five");
  EXPECT_EQ(said(bad),
            "16: PVRTX 2 does not have three coordinates; write its x, y and z\n"
            "20: there is no point 9; write points before the lines that use them\n"
            "21: point 3 is given twice; give each point its own number\n"
            "23: TRGL has no whole number at position 3; write the numbers of its points\n");
  EXPECT_EQ(said(changed(kSurface, "TRGL 1 2 3", "TRGL 1 2 8")),
            "18: there is no point 8; write its VRTX\n");
  std::string bare = changed(kSurface, "TRGL 1 2 3\n", "");
  EXPECT_EQ(said(changed(bare, "TRGL 4 6 5\n", "")),
            "1: the surface has no triangles; write its TRGL\n");
}

/// Comments before the first object, a mark of byte order, borders and wells beside the surface.
TEST(FaultSurface, WhatStandsAroundATSurfIsNoPartOfIt) {
  const std::string line = "GOCAD PLine 1\nHEADER {\nname:F\n}\nILINE\nVRTX 1 7 7 7\nEND\n";
  for (const std::string& text :
       {"# exported\n\n" + std::string(kSurface), "\xEF\xBB\xBF" + std::string(kSurface),
        kSurface + line, line + kSurface}) {
    const DrawnSurface surface = parse_fault_surface(text, "F.ts", "F");
    ASSERT_EQ(surface.points.size(), 4u) << text;
    EXPECT_EQ(surface.points[0], Vector3d(0, -100, -1500)) << text;
  }
  EXPECT_EQ(said("# exported\n" + line), "2: is not a TSurf; write the fault as a GOCAD TSurf\n");
}

TEST(FaultSurface, AHeaderIsClosedAndPointsAreThereOnceWithinReach) {
  EXPECT_EQ(said(changed(kSurface, "Main fault\n}", "Main fault")),
            "2: the HEADER is not closed; end it with }\n");
  EXPECT_EQ(said("GOCAD TSurf 1\nHEADER {\nname:F\n"),
            "2: the HEADER is not closed; end it with }\n")
      << "to the end of the file";
  EXPECT_EQ(said(changed(kSurface, "ATOM 4 2", "ATOM 3 2")),
            "20: point 3 is given twice; give each point its own number\n");
  EXPECT_EQ(said(changed(kSurface, "PVRTX 2 0 100 1500", "PVRTX 2 0 1e9 1500")),
            "16: PVRTX 2: \"1e9\" is beyond -10000 km to 10000 km; write coordinates in m or ft, "
            "as AXIS_UNIT says\n"
            "20: there is no point 2; write points before the lines that use them\n");
}

constexpr const char* kSticks = R"(# picked in depth
stick, x [m], y [km], depth [m]
A, 0, -1, 1500
A, 40, -1, 2000
A, 100, -1, 2500
"B", 110, 1, 2600
"B", 0, 1, 1400
)";

TEST(FaultSurface, ReadsSticks) {
  const DrawnSurface surface = parse_fault_surface(kSticks, "F.csv", "F");
  ASSERT_EQ(surface.points.size(), 5u);
  EXPECT_EQ(surface.points[1], Vector3d(40, -1000, -2000));
  ASSERT_EQ(surface.sticks.size(), 2u);
  EXPECT_THAT(surface.sticks[0], ElementsAre(0, 1, 2));
  EXPECT_THAT(surface.sticks[1], ElementsAre(4, 3)) << "from top to bottom";
  const std::string up = changed(kSticks, "depth [m]", "z [m]");
  EXPECT_EQ(parse_fault_surface(up, "F.csv", "F").points[1].z(), 2000);
}

TEST(FaultSurface, AllThatIsWrongWithSticksIsSaidByLine) {
  EXPECT_THAT(
      said(changed(kSticks, "depth [m]", "time [m]")),
      HasSubstr("2: column \"time\" does not describe sticks; name the columns stick, x [m], y "
                "[m], depth [m]"));
  EXPECT_THAT(said(changed(kSticks, ", depth [m]", "")), HasSubstr("2: a column is missing"));
  EXPECT_THAT(said(changed(kSticks, "A, 100, -1, 2500", "A, 100, -1, 1900")),
              HasSubstr("5: the stick \"A\" turns back in depth"));
  EXPECT_THAT(said(changed(kSticks, "A, 40, -1, 2000", "A, 40, -1, 1500")),
              HasSubstr("4: the stick \"A\" has two points at one depth"));
  EXPECT_THAT(said(std::string(kSticks) + "A, 1, 1, 1\n"),
              HasSubstr("8: the rows of stick \"A\" are not together"));
  EXPECT_THAT(said(std::string(kSticks) + "C, 1, 1, 1\n"),
              HasSubstr("the stick \"C\" has only one point"));
  EXPECT_THAT(said("stick,x [m],y [m],depth [m]\nA,0,0,0\nA,0,0,9\n"),
              HasSubstr("has only one stick"));
}

TEST(FaultSurface, NonsenseIsReadOrRefused) {
  std::mt19937 random(3);
  const std::string characters = "0123456789 -.,;\t\n\"#{}TRGLVXAOMe";
  int n_refused = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string text = round % 2 == 0 ? kSurface : kSticks;
    for (int change = 0; change < 1 + round % 5; ++change)
      text[random() % text.size()] = characters[random() % characters.size()];
    try {
      const DrawnSurface surface = parse_fault_surface(text, "F", "F");
      for (const auto& triangle : surface.triangles)
        for (const int v : triangle) EXPECT_LT(v, static_cast<int>(surface.points.size()));
      std::vector<Problem> problems;
      horizons::lines_of(surface, {}, -2000, 50, "/at", "F", problems);
    } catch (const InputError&) {
      ++n_refused;
    }
  }
  EXPECT_GT(n_refused, 250);
  EXPECT_LT(n_refused, 975);
}

}  // namespace
}  // namespace faultsim
