// What flow results say before anything is built: what they cover, and pressures that cannot be.
#include "simulator/plan/field_check.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "simulator/common/dates.h"
#include "simulator/flow/flow_field.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/plan/field_bodies.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class FieldCheckTest : public testing::Test {
 protected:
  explicit FieldCheckTest(json document = json::parse(starter_scene("field"))) {
    if (document["geometry"]["kind"] == "field") {
      document["numerics"] = {{"plane_strain", "on"}};
      document["faults"][1]["dip_from_vertical"] = "15 deg";
    }
    scene_ = read_scene(parse_json(document.dump(), "test"));
    std::vector<Problem> problems;
    plan_ = make_plan(scene_, problems);
    EXPECT_THAT(problems, IsEmpty());
    field_.date = {*parse_date("1990-01-01"), *parse_date("2000-01-01")};
    for (const MappedCell& body : field_bodies(scene_, plan_, 0)) {
      for (const Eigen::Vector3d& corner : body.corners) {
        low_ = low_.cwiseMin(corner);
        high_ = high_.cwiseMax(corner);
      }
    }
    low_.y() = -500;
    high_.y() = 500;
  }

  /// Cells of 50 m x all y x 20 m from `from` to `to` in x, at the initial pressure of the region
  /// there, which falls by 100 bar.
  void fill(double from, double to) {
    for (double x = from; x < to - 1; x += 50) {
      for (double z = low_.z(); z < high_.z() - 1; z += 20)
        field_.cells.push_back({{x, low_.y(), z}, {x + 50, high_.y(), z + 20}});
    }
    field_.value.resize(std::ssize(field_.cells), 2);
    for (Eigen::Index f = 0; f < field_.value.rows(); ++f) {
      const FlowCell& cell = field_.cells[static_cast<std::size_t>(f)];
      const double depth = -0.5 * (cell.low.z() + cell.high.z());
      field_.value(f, 0) = initial_region_pressure(scene_, cell.low.x() < 0 ? 0 : 1, depth);
    }
    field_.value.col(1) = field_.value.col(0).array() - 1e7;
  }

  FieldCheck check() {
    FlowLoad& load = scene_.pressure_field;
    load.field = std::make_shared<const FlowField>(field_);
    load.reports = {0, 1};
    return check_fields(scene_, plan_);
  }
  static std::vector<std::string> texts(const FieldCheck& check) {
    std::vector<std::string> all;
    for (const Remark& one : check.remarks) all.push_back(remark_text(one));
    return all;
  }

  Scene scene_;
  Plan plan_;
  FlowField field_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(1e9), high_ = -low_;
};

TEST_F(FieldCheckTest, HasNothingToSayOfAGridThatCoversAll) {
  fill(low_.x() - 50, high_.x() + 50);
  const FieldCheck found = check();
  EXPECT_THAT(found.problems, IsEmpty());
  EXPECT_THAT(texts(found), IsEmpty());
  EXPECT_THAT(found.notes,
              testing::ElementsAre("pressure_field covers 100 % of the volume of west",
                                   "pressure_field covers 100 % of the volume of east"));
}

TEST_F(FieldCheckTest, RefusesAGridElsewhereWithACure) {
  fill(low_.x(), high_.x());
  scene_.pressure_field.origin = {2e5, 0};
  const FieldCheck found = check();
  ASSERT_EQ(found.problems.size(), 1u);
  EXPECT_EQ(found.problems[0].pointer, "/pressure_field");
  EXPECT_THAT(found.problems[0].what,
              AllOf(HasSubstr("no flow cell lies in a compartment"), HasSubstr("x -20")));
  EXPECT_THAT(found.problems[0].cure, AllOf(HasSubstr("\"origin\""), HasSubstr("\"azimuth\"")));
  // Not even by saying what cells outside take.
  scene_.pressure_field.outside_given = true;
  EXPECT_EQ(check().problems.size(), 1u);
}

TEST_F(FieldCheckTest, RefusesLessThanHalfOfACompartmentUnlessOutsideIsSaid) {
  const double east = scene_.field.blocks[1].to, width = east - scene_.field.blocks[1].from;
  fill(low_.x() - 50, east - 0.6 * width);
  FieldCheck found = check();
  ASSERT_EQ(found.problems.size(), 1u);
  EXPECT_THAT(found.problems[0].what, AllOf(HasSubstr("% of the volume of east, which lies at x "),
                                            HasSubstr("; its cells at x ")));
  EXPECT_THAT(found.problems[0].cure, HasSubstr("\"outside\""));
  scene_.pressure_field.outside_given = true;
  found = check();
  EXPECT_THAT(found.problems, IsEmpty());
  EXPECT_THAT(texts(found), Contains(AllOf(HasSubstr("% of the volume of east; the rest takes what "
                                                     "the nearest flow cell has"))));
  EXPECT_THAT(texts(found),
              Contains("/pressure_field hardly reaches fault " + scene_.faults[2].name +
                       ": 0 % of the reservoir within 100 m of it is covered"));
}

/// A compartment that is covered by three quarters, but not where its fault is.
TEST_F(FieldCheckTest, NamesTheFaultThatIsNotReached) {
  fill(low_.x() - 50, -600);
  fill(600, high_.x() + 50);
  const std::vector<std::string> said = texts(check());
  EXPECT_THAT(said, Contains(HasSubstr("hardly reaches fault " + scene_.faults[1].name + ": 0 %")));
  EXPECT_THAT(said, Not(Contains(HasSubstr("hardly reaches fault " + scene_.faults[0].name))));
}

/// As a run would, on the mesh: the flow grid goes on far beyond the model.
TEST_F(FieldCheckTest, RefusesIntegralsThatCannotBeKept) {
  fill(low_.x(), high_.x());
  std::array<std::array<double, 2>, 2> range = {{{1e9, -1e9}, {1e9, -1e9}}};
  for (const MappedCell& body : field_bodies(scene_, plan_, 0)) {
    if (body.region > 1) continue;
    auto& [low, high] = range[static_cast<std::size_t>(body.region)];
    for (const Eigen::Vector3d& corner : body.corners) {
      low = std::min(low, corner.z());
      high = std::max(high, corner.z());
    }
  }
  std::erase_if(field_.cells, [&](const FlowCell& cell) {
    const auto& [low, high] = range[cell.low.x() < 0 ? 0 : 1];
    return cell.high.z() < low + 1 || cell.low.z() > high - 1;
  });
  fill(0, 0);  // values of those that are left
  scene_.pressure_field.integral = IntegralRule::flow_grid;
  EXPECT_THAT(check().problems, IsEmpty());
  fill(high_.x() + 50, high_.x() + 4 * (high_.x() - low_.x()));
  const std::vector<Problem> problems = check().problems;
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/pressure_field");
  EXPECT_THAT(problems[0].what, HasSubstr("the integrals of its change over east and over"));
  scene_.pressure_field.integral = IntegralRule::mapped;
  EXPECT_THAT(check().problems, IsEmpty());
}

TEST_F(FieldCheckTest, WarnsOfPressuresThatCannotBe) {
  fill(low_.x() - 50, high_.x() + 50);
  const double z = 0.5 * (low_.z() + high_.z()) + 1;
  const auto at = [&](double x) {
    for (std::size_t f = 0; f < field_.cells.size(); ++f) {
      const FlowCell& cell = field_.cells[f];
      if (cell.low.x() <= x && cell.high.x() > x && cell.low.z() <= z && cell.high.z() > z)
        return static_cast<Eigen::Index>(f);
    }
    ADD_FAILURE() << "no cell at " << x;
    return Eigen::Index{0};
  };
  field_.value(at(700), 1) = field_.value(at(700), 0) + 2e6;
  EXPECT_THAT(texts(check()),
              testing::ElementsAre(AllOf(
                  HasSubstr("/pressure_field rises to 20.0 bar above the initial pressure of east "
                            "at x "),
                  HasSubstr(" m on 2000-01-01"))));
  field_.value(at(700), 1) = 1e8;
  EXPECT_THAT(texts(check()), Contains(HasSubstr("above the least total principal stress of ")));
  fill(low_.x() - 50, low_.x() - 50);
  field_.value.col(0).array() += 1e7;
  field_.value.col(1).setZero();
  const std::vector<std::string> said = texts(check());
  EXPECT_THAT(said, Contains(HasSubstr("begins 100 bar above the initial pressure of west")));
  EXPECT_THAT(said, Contains(HasSubstr("more than the initial pressure of ")));
}

TEST_F(FieldCheckTest, TakesTheSectionWhereItIs) {
  fill(low_.x() - 50, high_.x() + 50);
  scene_.pressure_field.y = 499.75;  // a quarter of the section sticks out
  EXPECT_THAT(texts(check()), Contains(HasSubstr("covers 75 % of the volume of west")));
}

json box_with_a_disc() {
  json scene = json::parse(starter_scene("box"));
  scene["mesh"] = {{"strike", "100 m"}, {"dip", "50 m"}, {"normal", "50 m"}};
  scene["geometry"]["regions"] = {{{"name", "disc"},
                                   {"shape", "disc"},
                                   {"center", {"0 m", "0 m", "-2000 m"}},
                                   {"radius", "400 m"},
                                   {"thickness", "200 m"}}};
  return scene;
}

class FieldCheckOfABox : public FieldCheckTest {
 protected:
  FieldCheckOfABox() : FieldCheckTest(box_with_a_disc()) {}
};

TEST_F(FieldCheckOfABox, LooksAtTheCellsOfItsMesh) {
  field_.cells = {{{-5000, -5000, -2500}, {60, 5000, -1500}}};
  field_.value = Eigen::MatrixXd::Constant(1, 2, 2e7);
  EXPECT_THAT(texts(check()), Contains(HasSubstr(" % of the volume of disc; the rest")));
  field_.cells[0].high.x() = -500;
  EXPECT_THAT(check().problems, Not(IsEmpty()));
}

}  // namespace
}  // namespace faultsim
