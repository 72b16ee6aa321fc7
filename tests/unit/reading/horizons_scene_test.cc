#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "simulator/reading/changed_scene.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/files/scratch_folder.h"

/// Scenes whose body is built of horizons and traces.
namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;
constexpr const char* kScene = R"({
  "format": 1,
  "materials": {
    "shale": { "youngs_modulus": "15 GPa", "poisson_ratio": 0.25 },
    "sand": { "youngs_modulus": "11 GPa", "poisson_ratio": 0.15 },
    "lime": { "youngs_modulus": "20 GPa", "poisson_ratio": 0.2 }
  },
  "geometry": {
    "kind": "horizons",
    "from": ["-2 km", "-2 km"], "to": ["2 km", "2 km"], "depth": "4 km", "trace_depth": "2 km",
    "layers": [
      { "name": "cover", "material": "shale", "top": "0 m" },
      { "name": "reservoir", "material": "sand", "outside": "lime", "top": "1900 m" },
      { "name": "base", "material": "shale", "top": { "depth": "2100 m", "at": ["-2 km", "0 m"], "slope": [0.01, 0] } }
    ],
    "compartments": [
      { "name": "west", "inside": ["-500 m", "0 m"], "layers": ["reservoir"] },
      { "name": "east", "inside": ["500 m", "0 m"], "layers": ["reservoir"] }
    ],
    "dividers": [ { "name": "rim", "line": [["1 km", "-2 km"], ["1 km", "2 km"]] } ]
  },
  "mesh": { "strike": "200 m" },
  "initial_state": { "kind": "profile", "vertical_stress_gradient": "-23 kPa/m", "pressure_gradient": "10 kPa/m" },
  "friction": { "friction_angle": "28 deg" },
  "faults": [
    { "name": "F1", "trace": [["0 m", "-2 km"], ["0 m", "2 km"]], "first_end": "edge", "last_end": "edge",
      "dip_from_vertical": "20 deg", "top": "1600 m", "bottom": "2500 m", "throw": "80 m", "throw_share": 0 }
  ],
  "stages": [ { "name": "production", "duration": "20 years", "steps": 5, "pressure_change": "-150 bar" } ]
})";

class HorizonsScene : public testing::Test {
 protected:
  using Changes = std::vector<std::pair<std::string, std::string>>;

  JsonDocument document(const Changes& changes = {}) const {
    JsonDocument document = parse_json(kScene, (scratch_.path() / "scene.json").string());
    for (const auto& [pointer, value] : changes) set_value(document, pointer, value);
    return document;
  }
  Scene read(const Changes& changes = {}) const { return read_scene(document(changes)); }
  std::string said(const Changes& changes) const {
    try {
      read(changes);
    } catch (const InputError& error) {
      std::string text;
      for (const Problem& problem : error.problems())
        text += problem.pointer + ": " + problem.what + "; " + problem.cure + "\n";
      return text;
    }
    return "";
  }
  std::string geometry_text(const Changes& changes = {}) const {
    return canonical_parts(read(changes)).geometry;
  }
  const ScratchFolder scratch_;
};

TEST_F(HorizonsScene, SaysABody) {
  const Scene scene = read();
  ASSERT_TRUE(is_meshed(scene));
  EXPECT_THAT(scene.box.from, ElementsAre(-2000, -2000, -4000));
  EXPECT_THAT(scene.box.to, ElementsAre(2000, 2000, 0));
  EXPECT_THAT(region_names(scene), ElementsAre("west", "east"));
  std::vector<std::string> volumes;
  for (const MeshVolume& volume : scene.box.mesh->volumes)
    volumes.push_back(volume.name + ": " + volume.material + ", " + volume.compartment);
  EXPECT_THAT(volumes,
              ElementsAre("cover: shale, ", "reservoir: lime, ", "reservoir in west: sand, west",
                          "reservoir in east: sand, east", "base: shale, "));
  EXPECT_THAT(scene.box.mesh->content->facet_groups,
              ElementsAre("x-", "x+", "y-", "y+", "z-", "z+", "F1"));
}

/// The plane base lies at 2100 + 0.01 (x + 2000) m, and what is right of the fault 80 m deeper.
TEST_F(HorizonsScene, AThrowLowersWhatIsRightOfTheTrace) {
  const std::vector<PressureRegion> regions = read().box.regions;
  EXPECT_NEAR(regions[0].to[2], -1900, 1e-6);
  EXPECT_NEAR(regions[1].to[2], -1980, 1e-6);
  // At the fault, which leans by tan 20° from x = 0 at 2000 m.
  const double lean = std::tan(20 * kDegree);
  const double x = (120 * lean) / (1 - 0.01 * lean);
  EXPECT_NEAR(regions[0].from[2], -2120 - 0.01 * x, 1e-6);
  EXPECT_NEAR(regions[1].from[2], -2180 - 0.01 * 3000, 1);
  // The same about a trace that runs the other way, and a fault that leans to the other side.
  const Changes turned = {{"/faults/0/trace", R"([["0 m", "2 km"], ["0 m", "-2 km"]])"},
                          {"/faults/0/throw", "-80 m"},
                          {"/faults/0/throw_share", "1"},
                          {"/faults/0/dip_from_vertical", "-20 deg"}};
  const std::vector<PressureRegion> others = read(turned).box.regions;
  EXPECT_NEAR(others[1].to[2], -1980, 1e-6);
  EXPECT_NEAR(others[0].from[2], regions[0].from[2], 1e-6);
}

TEST_F(HorizonsScene, AFaultDipsToTheRightOfItsTrace) {
  const PatchGeometry east = read().box.patches.at(0);
  EXPECT_NEAR(east.dip_from_vertical, 20 * kDegree, 1e-9);
  EXPECT_NEAR(east.center[2], -2050, 30);
  const PatchGeometry west = read({{"/faults/0/dip_from_vertical", "-20 deg"}}).box.patches.at(0);
  EXPECT_NEAR(west.dip_from_vertical, -20 * kDegree, 1e-9);
  // A profile as steep as the dip.
  const std::string shift = std::to_string(500 * std::tan(20 * kDegree));
  for (const std::string sign : {"", "-"}) {
    JsonDocument curved = document();
    curved.value["faults"][0].erase("dip_from_vertical");
    curved.value["faults"][0]["listric"] = {{{"depth", "2000 m"}, {"shift", "0 m"}},
                                            {{"depth", "2500 m"}, {"shift", sign + shift + " m"}}};
    const double dip = read_scene(curved).box.patches.at(0).dip_from_vertical;
    EXPECT_EQ(dip > 0, sign.empty());
    EXPECT_NEAR(std::abs(dip), 20 * kDegree, 7 * kDegree);  // above its first point it is vertical
  }
}

TEST_F(HorizonsScene, ADipPerPointOfTheTraceIsLinearBetween) {
  const Changes three = {
      {"/faults/0/trace", R"([["0 m", "-2 km"], ["0 m", "0 m"], ["0 m", "2 km"]])"}};
  const auto dips = [&](const std::string& list) {
    Changes changes = three;
    changes.emplace_back("/faults/0/dip_from_vertical", list);
    return read(changes);
  };
  EXPECT_EQ(dips(R"(["20 deg", "20 deg", "20 deg"])").box, dips("20 deg").box);
  const Scene scene = dips(R"(["10 deg", "-20 deg", "40 deg"])");
  const NamedMesh& mesh = *scene.box.mesh->content;
  const double lean[] = {std::tan(10 * kDegree), std::tan(-20 * kDegree), std::tan(40 * kDegree)};
  int n = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_groups[mesh.facet_group[f]] != "F1") continue;
    for (int v = 0; v < 3; ++v) {
      const Eigen::Vector3d& at = mesh.nodes[mesh.facets[f][v]];
      const double part = std::abs(at.y()) / 2000;
      const double there = (1 - part) * lean[1] + part * lean[at.y() < 0 ? 0 : 2];
      EXPECT_NEAR(at.x(), there * (-2000 - at.z()), 1e-9) << "at y " << at.y() << ", z " << at.z();
      ++n;
    }
  }
  EXPECT_GT(n, 100);
  EXPECT_EQ(scene.faults[0].dip_from_vertical, 0) << "the mesh says it";
}

TEST_F(HorizonsScene, ListsOfDipsAreHeldAgainstTheTrace) {
  EXPECT_THAT(said({{"/faults/0/dip_from_vertical", R"(["20 deg", "30 deg", "20 deg"])"}}),
              HasSubstr("/faults/0/dip_from_vertical: has 3 dips for 2 points of the trace; write "
                        "one for each point, or one for all"));
  EXPECT_THAT(said({{"/faults/0/dip_from_vertical", R"(["20 deg", "87 deg"])"}}),
              HasSubstr("/faults/0/dip_from_vertical/1: \"F1\" dips by 3 degrees"));
  EXPECT_THAT(said({{"/faults/0/dip_from_vertical", R"(["20 deg", "100 deg"])"}}),
              HasSubstr("/faults/0/dip_from_vertical/1: \"100 deg\" is above 90 deg"));
  const std::string listric =
      R"([{"depth": "2 km", "shift": "0 m"}, {"depth": "2 km", "shift": "9 m"}])";
  JsonDocument curved = document({{"/faults/0/listric", listric}});
  EXPECT_THAT(
      said({{"/faults/0/listric", listric}}),
      HasSubstr(
          "/faults/0/dip_from_vertical: the fault has a listric profile that says how it dips"));
  curved.value["faults"][0].erase("dip_from_vertical");
  try {
    read_scene(curved);
    ADD_FAILURE() << "two points of the profile are at one depth";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/faults/0/listric: a profile of \"F1\" does not go down"));
  }
}

/// Corners of the facets of a fault.
std::vector<std::array<Eigen::Vector3d, 3>> facets_of(const Scene& scene, const std::string& name) {
  const NamedMesh& mesh = *scene.box.mesh->content;
  std::vector<std::array<Eigen::Vector3d, 3>> facets;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_groups[mesh.facet_group[f]] != name) continue;
    facets.push_back({mesh.nodes[mesh.facets[f][0]], mesh.nodes[mesh.facets[f][1]],
                      mesh.nodes[mesh.facets[f][2]]});
  }
  return facets;
}

std::string surface_text(const std::vector<std::array<Eigen::Vector3d, 3>>& facets) {
  std::string points, triangles;
  int n = 0;
  for (const auto& facet : facets) {
    for (const Eigen::Vector3d& at : facet)
      points += concat("VRTX ", ++n, " ", at.x(), " ", at.y(), " ", -at.z(), "\n");
    triangles += concat("TRGL ", n - 2, " ", n - 1, " ", n, "\n");
  }
  return "GOCAD TSurf 1\nHEADER { name:F1 }\nZPOSITIVE Depth\nTFACE\n" + points + triangles +
         "END\n";
}

class SurfaceScene : public HorizonsScene {
 protected:
  /// The scene with the surface F1.ts in place of the keys that say where F1 is.
  JsonDocument of_surface(const std::string& text) const {
    std::ofstream(scratch_.path() / "F1.ts") << text;
    JsonDocument one = document();
    for (const char* key : {"trace", "dip_from_vertical", "top", "bottom"})
      one.value["faults"][0].erase(key);
    one.value["faults"][0]["surface"] = "F1.ts";
    return one;
  }
  std::string refusal(const JsonDocument& document) const {
    try {
      read_scene(document);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  const std::string leaning_ = surface_text(
      facets_of(read({{"/faults/0/dip_from_vertical", R"(["10 deg", "35 deg"])"}}), "F1"));
};

TEST_F(SurfaceScene, AFaultThatWasWrittenIsReadAsItWas) {
  const auto before =
      facets_of(read({{"/faults/0/dip_from_vertical", R"(["10 deg", "35 deg"])"}}), "F1");
  const Scene scene = read_scene(of_surface(leaning_));
  const auto after = facets_of(scene, "F1");
  ASSERT_EQ(after.size(), before.size());
  // Where two diagonals are as good rounding decides, so points are compared, not triangles.
  for (const auto& facet : after)
    for (const Eigen::Vector3d& at : facet) {
      double nearest = 1e300;
      for (const auto& other : before)
        for (const Eigen::Vector3d& there : other) nearest = std::min(nearest, (at - there).norm());
      EXPECT_LT(nearest, 1e-6) << at.transpose();
    }
}

TEST_F(SurfaceScene, ItsFileIsPartOfTheBodyAndTravels) {
  JsonDocument travelled = of_surface(leaning_);
  const std::string text = canonical_parts(read_scene(travelled)).geometry;
  const JsonDocument other = of_surface(surface_text(
      facets_of(read({{"/faults/0/dip_from_vertical", R"(["10 deg", "30 deg"])"}}), "F1")));
  EXPECT_NE(canonical_parts(read_scene(other)).geometry, text) << "by what is in the file";
  of_surface(leaning_);
  embed_tables(travelled);
  std::filesystem::remove(scratch_.path() / "F1.ts");
  EXPECT_EQ(canonical_parts(read_scene(travelled)).geometry, text);
}

TEST_F(SurfaceScene, SticksAreASurface) {
  const JsonDocument sticks = of_surface(
      "stick, x [m], y [m], depth [m]\n1, 100, -2000, 1500\n1, -200, -2000, 2600\n"
      "2, 0, 0, 1500\n2, 0, 0, 2600\n3, 100, 2000, 1500\n3, -200, 2000, 2600\n");
  const Scene scene = read_scene(sticks);
  for (const auto& facet : facets_of(scene, "F1"))
    for (const Eigen::Vector3d& at : facet) {
      const double along = std::abs(at.y()) / 2000, down = -1500 - at.z();
      EXPECT_NEAR(at.x(), along * (100 - 300 * down / 1100), 1) << at.transpose();
    }
}

TEST_F(SurfaceScene, WhatIsWrongIsSaidAtItsPlace) {
  EXPECT_THAT(refusal(of_surface("GOCAD TSurf 1\nTRGL 1 2 3\n")),
              HasSubstr("/faults/0/surface: F1.ts line 2: there is no point 1"));
  JsonDocument two = of_surface(leaning_);
  two.value["faults"][0]["dip_from_vertical"] = "10 deg";
  EXPECT_THAT(refusal(two), HasSubstr("/faults/0/dip_from_vertical: the fault has a surface that "
                                      "says how it dips"));
  JsonDocument deeper = of_surface(leaning_);
  deeper.value["geometry"]["trace_depth"] = "3 km";
  EXPECT_THAT(refusal(deeper), HasSubstr("/faults/0/surface: the surface of \"F1\" reaches from "));
  JsonDocument weak = of_surface(leaning_);
  weak.value["faults"][0]["friction"] = {{"friction_angle", "-3 deg"}};
  EXPECT_THAT(refusal(weak), testing::Not(HasSubstr("/faults/0/surface")));
  JsonDocument shallow = of_surface(leaning_);
  shallow.value["geometry"]["layers"][2]["top"] = "2600 m";
  EXPECT_THAT(refusal(shallow), HasSubstr("/faults/0/surface: the surface of \"F1\" ends within "
                                          "the reservoir: at x "));
  shallow.value["faults"][0]["bottom"] = "2900 m";
  EXPECT_EQ(refusal(shallow), "");
  JsonDocument longer = of_surface(
      "stick, x [m], y [m], depth [m]\n1, 100, -3000, 1500\n1, -200, -3000, 2600\n"
      "2, 100, 3000, 1500\n2, -200, 3000, 2600\n");
  EXPECT_THAT(
      refusal(longer),
      testing::AllOf(HasSubstr("/faults/0/surface: the surface of \"F1\" is longer than the "
                               "box, which it leaves at x "),
                     HasSubstr("write a \"trace\", its line as far as it is to lie in")));
  longer.value["faults"][0]["trace"] =
      nlohmann::json::parse(R"([["-36 m", "-2 km"], ["-36 m", "2 km"]])");
  EXPECT_EQ(refusal(longer), "");
  std::filesystem::remove(scratch_.path() / "F1.ts");
  EXPECT_THAT(refusal(two), HasSubstr("/faults/0/surface"));
}

TEST_F(HorizonsScene, SidesAndBaseAreHeldUnlessItSaysMore) {
  const Scene scene = read();
  ASSERT_EQ(scene.box.boundary.size(), 1u);
  EXPECT_EQ(scene.box.boundary[0].kind, BoundaryKind::roller);
  EXPECT_THAT(scene.box.boundary[0].surfaces, ElementsAre("x-", "x+", "y-", "y+", "z-"));
  const Scene other = read({{"/geometry/boundary", R"([{"surfaces": ["z-"], "kind": "fixed"}])"}});
  ASSERT_EQ(other.box.boundary.size(), 1u);
  EXPECT_EQ(other.box.boundary[0].kind, BoundaryKind::fixed);
}

TEST_F(HorizonsScene, ATableIsAHorizon) {
  std::ofstream(scratch_.path() / "top.csv")
      << "x [m], y [m], depth [m]\n-2000, -2000, 1900\n2000, -2000, 1900\n-2000, 2000, 1900\n"
         "2000, 2000, 1900\n";
  const Changes table = {{"/geometry/layers/1/top", R"({"csv": "top.csv"})"}};
  EXPECT_NEAR(read(table).box.regions[0].to[2], -1900, 1e-6);
  // It travels with the scene.
  JsonDocument travelled = document(table);
  embed_tables(travelled);
  std::filesystem::remove(scratch_.path() / "top.csv");
  EXPECT_NEAR(read_scene(travelled).box.regions[0].to[2], -1900, 1e-6);
  std::ofstream(scratch_.path() / "top.csv") << "x [m], y [m], height [m]\n0, 0, 1\n";
  EXPECT_THAT(
      said(table),
      HasSubstr(
          "/geometry/layers/1/top/csv: top.csv line 1: column "
          "\"height\" does not describe a horizon; name the columns x [m], y [m], depth [m]"));
}

TEST_F(HorizonsScene, ATableOfThicknessesHangsFromTheOneAbove) {
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(scratch_.path() / name) << text;
  };
  write("top.csv",
        "x [m], y [m], depth [m]\n-2000, -2000, 1900\n2000, -2000, 1900\n"
        "-2000, 2000, 1900\n2000, 2000, 1900\n");
  const std::string places[] = {"-2000, -2000, ", "2000, -2000, ", "-2000, 2000, ", "2000, 2000, "};
  const auto thicknesses = [&](const std::string& last) {
    write("base.csv", "x [m], y [m], thickness [m]\n" + places[0] + "80\n" + places[1] + "80\n" +
                          places[2] + "80\n" + last);
  };
  const Changes tables = {{"/geometry/layers/1/top", R"({"csv": "top.csv"})"},
                          {"/geometry/layers/2/top", R"({"csv": "base.csv"})"}};
  thicknesses(places[3] + "80\n");
  const Scene scene = read(tables);
  EXPECT_NEAR(scene.box.regions[0].to[2], -1900, 1e-6);
  EXPECT_NEAR(scene.box.regions[0].from[2], -1980, 1e-6);
  const std::string at = "/geometry/layers/2/top/csv: base.csv";
  thicknesses("");
  EXPECT_THAT(said(tables), HasSubstr(at + " has 3 thicknesses, but the table of the layer above "
                                           "has 4 points; give a thickness for each line"));
  thicknesses("2000, 1999, 80\n");
  EXPECT_THAT(said(tables),
              HasSubstr(at + " line 5: x 2000, y 1999 m is not the place of the "
                             "point in the table of the layer above, x 2000, y 2000"));
  thicknesses(places[3] + "0\n");
  EXPECT_THAT(said(tables), HasSubstr(at + " line 5: a thickness is not above 0"));
  thicknesses(places[3] + "80\n");
  EXPECT_THAT(said({tables[1]}),
              HasSubstr(at + " has thicknesses, but the top of the layer above is not a table"));
}

/// Growth is a factor from one cell to the next: 1 keeps their size.
TEST_F(HorizonsScene, CellsGrowByAFactor) {
  const auto n_cells = [&](const Changes& changes) {
    return static_cast<double>(read(changes).box.mesh->content->cell_group.size());
  };
  const double alike = n_cells({{"/mesh/largest", "200 m"}});
  EXPECT_NEAR(n_cells({{"/mesh/growth", "1.001"}}), alike, 0.05 * alike);
}

TEST_F(HorizonsScene, EveryProblemOfKeysIsSaidAtOnce) {
  EXPECT_EQ(said({{"/geometry/layers/1/material", "granite"},
                  {"/geometry/layers/0/top", R"({"depth": "0 m"})"},
                  {"/geometry/compartments/0/layers/0", "\"chalk\""},
                  {"/faults/0/length", "2 km"},
                  {"/mesh/dip", "20 m"},
                  {"/tier", "standard"}}),
            "/geometry/layers/0/top: the first layer begins at the top of the model, which is "
            "level; write its depth, \"0 m\" for the surface\n"
            "/geometry/layers/1/material: there is no material \"granite\"; write one of "
            "\"lime\", \"sand\", \"shale\"\n"
            "/geometry/compartments/0/layers/0: there is no layer \"chalk\"; write one of "
            "\"cover\", \"reservoir\", \"base\"\n"
            "/tier: has no effect: bodies of horizons have their sizes in \"mesh\"; remove it\n"
            "/mesh/dip: has no effect in a body of horizons; remove it; strike is the size of "
            "cells at the faults\n"
            "/faults/0/length: a fault of horizons has a trace; remove it; trace, top and bottom "
            "say where it is\n");
}

TEST_F(HorizonsScene, CommentsAndAMissingKindSayNothingOfFaults) {
  EXPECT_EQ(said({{"/mesh/comment", "as fine as it goes"}}), "");
  JsonDocument bare = document();
  bare.value["geometry"].erase("kind");
  try {
    read_scene(bare);
    ADD_FAILURE() << "it has no kind";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("/faults/0/trace")));
  }
}

TEST_F(HorizonsScene, WhatCannotBeBuiltIsSaidWithItsPlace) {
  EXPECT_THAT(said({{"/geometry/layers/2/top", "1880 m"}}), HasSubstr("/geometry/layers/"));
  EXPECT_THAT(said({{"/faults/0/dip_from_vertical", "88 deg"}}),
              HasSubstr("/faults/0/dip_from_vertical: \"F1\" dips by 2 degrees"));
  EXPECT_THAT(said({{"/geometry/compartments/1/inside", R"(["-600 m", "0 m"])"}}),
              HasSubstr("/geometry/compartments/1/inside: "));
  EXPECT_THAT(said({{"/geometry/compartments/0/also_inside", R"([["600 m", "0 m"]])"}}),
              HasSubstr("are in one part of the map"));
  JsonDocument bare = document();
  bare.value["faults"][0].erase("trace");
  bare.value.erase("mesh");
  try {
    read_scene(bare);
    ADD_FAILURE() << "it has neither a trace nor a size";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the fault \"F1\" has no trace"));
    EXPECT_THAT(error.what(), HasSubstr("the cells have no size at the faults"));
  }
  EXPECT_THAT(said({{"/faults/0/name", "x-"}}), HasSubstr("is the name of a side of the body"));
}

TEST_F(HorizonsScene, ItsIdentityIsThatOfItsBody) {
  const std::string text = geometry_text();
  EXPECT_EQ(geometry_text({{"/faults/0/friction/friction_angle", "20 deg"}}), text);
  EXPECT_EQ(geometry_text({{"/geometry/layers/1/top", R"({"depth": "1.9 km"})"}}), text);
  EXPECT_NE(geometry_text({{"/faults/0/throw", "81 m"}}), text);
  EXPECT_NE(geometry_text({{"/mesh/growth", "1.35"}}), text);
  EXPECT_NE(geometry_text({{"/geometry/layers/1/outside", "sand"}}), text);
  EXPECT_NE(geometry_text({{"/geometry/compartments/0/layers", R"(["reservoir", "base"])"}}), text);
  // Cases that change strengths alone share one body in memory.
  EXPECT_EQ(read({{"/friction/friction_angle", "20 deg"}}).box.mesh->content,
            read({{"/friction/friction_angle", "21 deg"}}).box.mesh->content);
}

TEST_F(HorizonsScene, AChangeOfTheBaseIsReadLikeTheWhole) {
  const JsonDocument base = document();
  ChangedScene changed;
  for (const auto& [pointer, value] : std::vector<std::pair<std::string, nlohmann::json>>{
           {"/faults/0/throw", "60 m"},
           {"/faults/0/throw", "70 m"},
           {"/faults/0/dip_from_vertical", {"15 deg", "25 deg"}},
           {"/geometry/depth", "4100 m"},
           {"/mesh/strike", "250 m"},
           {"/faults/0/friction/friction_angle", "25 deg"},
           {"/faults/0/friction/friction_angle", "22 deg"},
           {"/friction/friction_angle", "20 deg"}}) {
    std::vector<Problem> problems;
    change_scene(base, {{pointer, value}}, Relations::checked, changed, problems);
    ASSERT_TRUE(problems.empty()) << pointer;
    JsonDocument whole = base;
    put_value(whole.value, pointer, value);
    const Scene expected = read_scene(whole);
    EXPECT_EQ(changed.scene.box, expected.box) << pointer;
    EXPECT_EQ(changed.scene.faults, expected.faults) << pointer;
  }
}

TEST_F(HorizonsScene, AnElementOfAListOfDipsIsChangedAlone) {
  const JsonDocument base = document({{"/faults/0/dip_from_vertical", R"(["15 deg", "25 deg"])"}});
  ChangedScene changed;
  for (const char* dip : {"18 deg", "20 deg"}) {
    std::vector<Problem> problems;
    change_scene(base, {{"/faults/0/dip_from_vertical/1", dip}}, Relations::checked, changed,
                 problems);
    ASSERT_TRUE(problems.empty());
    JsonDocument whole = base;
    put_value(whole.value, "/faults/0/dip_from_vertical/1", dip);
    EXPECT_EQ(changed.scene.box, read_scene(whole).box) << dip;
  }
  EXPECT_EQ(resolve_parameter(base, "dip_F1"), "/faults/0/dip_from_vertical");
  std::vector<std::string> new_family;
  for (const ParameterInfo& row : parameters(base))
    if (row.new_family) new_family.push_back(row.pointer);
  EXPECT_THAT(new_family, testing::Contains("/faults/0/dip_from_vertical/1"));
}

TEST_F(HorizonsScene, ItsKeysAreParameters) {
  const JsonDocument scene = document();
  EXPECT_EQ(resolve_parameter(scene, "throw_F1"), "/faults/0/throw");
  EXPECT_EQ(resolve_parameter(scene, "dip_F1"), "/faults/0/dip_from_vertical");
  EXPECT_EQ(resolve_parameter(scene, "mesh_strike"), "/mesh/strike");
  EXPECT_EQ(resolve_parameter(scene, "scale_west"), "/compartments/west/scale");
  EXPECT_THROW(resolve_parameter(scene, "tier"), InputError);
  std::vector<std::string> new_family;
  for (const ParameterInfo& row : parameters(scene))
    if (row.new_family) new_family.push_back(row.pointer);
  EXPECT_THAT(new_family, testing::Contains("/faults/0/throw"));
  EXPECT_THAT(new_family, testing::Not(testing::Contains("/faults/0/length")));
}

}  // namespace
}  // namespace faultsim
