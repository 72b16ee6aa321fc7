// Influence blocks of whole fields: what the operator knows of uniform compartments must follow.

#include "simulator/operators/influence.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "simulator/reading/read_scene.h"
#include "tests/unit/cache/example_operator.h"

namespace faultsim {
namespace {

using nlohmann::json;

/// A coarse field of 8 km, offset and dipping, half of it modelled, observed on both sides of y =
/// 0.
json half_field() {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"strike", "1000 m"}, {"dip", "150 m"}, {"normal", "300 m"}, {"growth", 2.0}};
  scene["geometry"]["width"] = "10 km";
  scene["geometry"]["length"] = "8 km";
  scene["output"]["observation_points"] = {
      {{"name", "north"}, {"position", {"500 m", "1500 m", "0 m"}}},
      {{"name", "south"}, {"position", {"500 m", "-1500 m", "0 m"}}}};
  return scene;
}

struct Planned {
  Scene scene;
  Plan plan;
  explicit Planned(const json& document) : scene(read_scene(parse_json(document.dump(), "test"))) {
    std::vector<Problem> problems;
    plan = make_plan(scene, problems);
    EXPECT_TRUE(problems.empty());
  }
};

/// Uniform fields against the columns of L and U, per region and material.
void expect_the_columns(const PreparedInfluence& made) {
  const FaultOperator& op = *made.op;
  const InfluenceBlock& block = *made.block;
  int n_columns = 0;
  for (std::size_t k = 0; k < op.loads.keys.size(); ++k) {
    const LoadKey& key = op.loads.keys[k];
    if (key.kind != LoadKey::Kind::pressure) continue;
    Eigen::VectorXd field = Eigen::VectorXd::Zero(block.traction.view().cols());
    for (std::size_t c = 0; c < block.cells.size(); ++c) {
      const InfluenceCell& cell = block.cells[c];
      if (cell.region == key.index && cell.material == key.material) field[c] = cell.fraction;
    }
    if (field.sum() == 0) continue;
    ++n_columns;
    const Eigen::VectorXd column = op.loads.traction.col(k);
    EXPECT_LT((locked_change(block, field) - column).norm(), 1e-12 * column.norm()) << k;
    const Eigen::VectorXd observed = op.observed.per_load.col(k);
    EXPECT_LT((block.observed * field - observed).norm(), 1e-12 * observed.norm()) << k;
  }
  EXPECT_GE(n_columns, 1);
}

TEST(PrepareInfluence, HoldsInHalfADomainAndInPlaneStrain) {
  json plane = half_field();
  plane["numerics"] = {{"plane_strain", "on"}};
  plane["mesh"]["dip"] = "50 m";
  for (const json& document : {half_field(), plane}) {
    const Planned at(document);
    EXPECT_NE(at.plan.plane_strain, at.plan.half_domain);
    SilentMonitor monitor;
    const PreparedInfluence made = prepare_influence(SceneBulk(at.scene, at.plan), {}, {}, monitor);
    EXPECT_FALSE(made.from_cache);
    EXPECT_EQ(made.block->region_names.size(), at.scene.pressure.size());
    expect_the_columns(made);
    // Bytes are counted, but for jumps that boundaries and ends of faults take.
    const double bytes = 8.0 * static_cast<double>(made.block->traction.view().size());
    EXPECT_GT(made.predicted.bytes, 0.9 * bytes);
    EXPECT_LT(made.predicted.bytes, 1.3 * bytes);
  }
}

TEST(PrepareInfluence, IsKeptBesideTheOperatorAndMappedTheNextTime) {
  const ScratchFolder folder;
  const CachePolicy cache{.folder = folder.path()};
  json document = half_field();
  document["numerics"] = {{"plane_strain", "on"}};
  const Planned at(document);
  SilentMonitor monitor;
  const PreparedInfluence built =
      prepare_influence(SceneBulk(at.scene, at.plan), {}, cache, monitor);
  const PreparedInfluence found =
      prepare_influence(SceneBulk(at.scene, at.plan), {}, cache, monitor);
  EXPECT_FALSE(built.from_cache);
  EXPECT_TRUE(found.from_cache) << found.remark;
  EXPECT_EQ(folder.n_entries(), 2u);
  EXPECT_TRUE(found.block->traction.view() == built.block->traction.view());
  expect_the_columns(found);

  // One region alone is another block, whose cells have the bits that they have among all.
  const PreparedInfluence one =
      prepare_influence(SceneBulk(at.scene, at.plan), {1}, cache, monitor);
  EXPECT_FALSE(one.from_cache);
  EXPECT_EQ(folder.n_entries(), 3u);
  EXPECT_LT(one.block->cells.size(), built.block->cells.size());
  const auto all = built.block->traction.view();
  std::size_t c = 0;
  for (std::size_t k = 0; k < one.block->cells.size(); ++k) {
    while (built.block->cells[c].cell != one.block->cells[k].cell) ++c;
    EXPECT_EQ(one.block->cells[k].region, 1);
    ASSERT_EQ(Eigen::VectorXd(one.block->traction.view().col(k)), Eigen::VectorXd(all.col(c)));
  }

  // A damaged block is built again, and the operator beside it stays what it was.
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().string().find("-influence-") == std::string::npos) continue;
    std::filesystem::resize_file(entry.path(), 5000);
  }
  const PreparedInfluence again =
      prepare_influence(SceneBulk(at.scene, at.plan), {}, cache, monitor);
  EXPECT_FALSE(again.from_cache);
  EXPECT_THAT(again.remark, testing::HasSubstr("influence file"));
  EXPECT_TRUE(again.block->traction.view() == all);
}

TEST(PrepareInfluence, DoesNotChangeTheOperator) {
  json document = half_field();
  document["numerics"] = {{"plane_strain", "on"}};
  const Planned at(document);
  SilentMonitor monitor;
  const auto plain = prepare_operator(at.scene, at.plan, {}, false, monitor).op;
  const auto beside = prepare_influence(SceneBulk(at.scene, at.plan), {}, {}, monitor).op;
  EXPECT_EQ(beside->fingerprint, plain->fingerprint);
  EXPECT_TRUE(beside->h() == plain->h());
  EXPECT_EQ(beside->loads.traction, plain->loads.traction);
}

}  // namespace
}  // namespace faultsim
