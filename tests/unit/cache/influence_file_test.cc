#include "simulator/cache/influence_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "simulator/common/errors.h"
#include "simulator/files/output_target.h"
#include "tests/unit/cache/example_operator.h"
#include "tests/unit/result_files/h5_file.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

InfluenceBlock example_block(const FaultOperator& op, int n_cells) {
  InfluenceBlock block{.fingerprint = "block",
                       .operator_fingerprint = op.fingerprint,
                       .region_names = {"west", "east"},
                       .build_seconds = 12.5};
  for (int c = 0; c < n_cells; ++c) {
    block.cells.push_back({.cell = 7 * c,
                           .region = c % 3 - 1,
                           .fraction = c % 3 == 0 ? 0 : 0.25 * (1 + c % 4),
                           .material = c % 2,
                           .volume = 1e4 + c,
                           .centroid = {100.0 * c, -3, -2000.0 - c}});
  }
  block.traction = StoredMatrix(Eigen::MatrixXd::Random(op.geometry.n_dofs, n_cells));
  block.observed = Eigen::MatrixXd::Random(op.observed.rows.size(), n_cells);
  return block;
}

TEST(InfluenceFile, GivesBackWhatWasWritten) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a", 3);
  const InfluenceBlock block = example_block(op, 11);
  const auto path = folder.path() / "block.h5";
  write_influence(block, op, path);
  std::string remark;
  const auto copy = read_influence(path, "block", &remark);
  ASSERT_TRUE(copy.has_value()) << remark;
  std::filesystem::remove(path);  // P is mapped and outlives the name
  EXPECT_TRUE(copy->traction.view() == block.traction.view());
  EXPECT_TRUE(copy->observed == block.observed);
  EXPECT_EQ(copy->operator_fingerprint, op.fingerprint);
  EXPECT_EQ(copy->region_names, block.region_names);
  EXPECT_EQ(copy->build_seconds, 12.5);
  ASSERT_EQ(copy->cells.size(), 11u);
  for (std::size_t c = 0; c < 11; ++c) {
    EXPECT_EQ(copy->cells[c].cell, block.cells[c].cell);
    EXPECT_EQ(copy->cells[c].region, block.cells[c].region);
    EXPECT_EQ(copy->cells[c].fraction, block.cells[c].fraction);
    EXPECT_EQ(copy->cells[c].material, block.cells[c].material);
    EXPECT_EQ(copy->cells[c].volume, block.cells[c].volume);
    EXPECT_EQ(copy->cells[c].centroid, block.cells[c].centroid);
  }
}

TEST(InfluenceFile, WithoutCellsIsFine) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  write_influence(example_block(op, 0), op, folder.path() / "none.h5");
  const auto copy = read_influence(folder.path() / "none.h5", "block");
  ASSERT_TRUE(copy.has_value());
  EXPECT_EQ(copy->traction.view().cols(), 0);
}

TEST(InfluenceFile, OfAnotherOperatorIsRefused) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  const InfluenceBlock block = example_block(op, 2);
  EXPECT_THROW(write_influence(block, example_operator("b"), folder.path() / "x.h5"),
               InternalError);
  EXPECT_EQ(folder.n_entries(), 0u);
}

TEST(InfluenceFile, DamagedOrAnotherIsAbsentWithARemark) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  const auto path = folder.path() / "block.h5";
  std::string remark;
  EXPECT_FALSE(read_influence(path, "block", &remark).has_value());
  EXPECT_EQ(remark, "");
  write_influence(example_block(op, 5), op, path);
  EXPECT_FALSE(read_influence(path, "another", &remark).has_value());
  EXPECT_THAT(remark, HasSubstr("it holds the influence block block"));

  write_influence(example_block(op, 5), op, path);
  std::string bytes;
  {
    std::ifstream in(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  bytes[bytes.size() - 50] ^= 4;
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_FALSE(read_influence(path, "block", &remark).has_value());
  EXPECT_THAT(remark, HasSubstr("influence file"));
  EXPECT_THAT(remark, HasSubstr("checksum"));
}

TEST(InfluenceFile, MayBeReplacedAsTheHdf5FileThatItIs) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  const auto path = folder.path() / "block.h5";
  write_influence(example_block(op, 1), op, path);
  EXPECT_NO_THROW(require_writable_file("-o", path, FileKind::hdf5, {}));
  EXPECT_THROW(require_writable_file("-o", path, FileKind::json, {}), InputError);
}

}  // namespace
}  // namespace faultsim
