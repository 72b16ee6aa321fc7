// The HDF5 layout of FCLib, as its documentation has it; that its library agrees is tests/peers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "simulator/common/errors.h"
#include "simulator/result_files/fclib_writer.h"

namespace faultsim {
namespace {

using testing::ElementsAre;

FrictionalContactProblem example() {
  FrictionalContactProblem problem;
  problem.dimension = 2;
  problem.w.resize(4, 4);
  problem.w << 4, 1, 0, 2, 1, 5, 3, 0, 0, 3, 6, 1, 2, 0, 1, 7;
  problem.q = Eigen::Vector4d(-1, 2, -3, 4);
  problem.friction = Eigen::Vector2d(0.1, 0.2);
  problem.displacement_unit = 0.01;
  problem.force_unit = 1e9;
  return problem;
}

class FclibFile : public testing::Test {
 protected:
  FclibFile()
      : path_(testing::TempDir() + "fclib_writer_test_" + std::to_string(getpid()) + ".hdf5") {
    std::filesystem::remove(path_);
  }
  void open() {
    file_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file_, 0);
  }
  ~FclibFile() override {
    if (file_ >= 0) H5Fclose(file_);
    std::filesystem::remove(path_);
  }
  template <typename Value>
  std::vector<Value> read(const char* name, hid_t type) const {
    const hid_t dataset = H5Dopen2(file_, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    std::vector<Value> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Sclose(space);
    H5Dclose(dataset);
    return values;
  }
  std::vector<int> ints(const char* name) const { return read<int>(name, H5T_NATIVE_INT); }
  std::vector<double> doubles(const char* name) const {
    return read<double>(name, H5T_NATIVE_DOUBLE);
  }
  std::string text(const char* name) const {
    const hid_t dataset = H5Dopen2(file_, name, H5P_DEFAULT);
    const hid_t type = H5Dget_type(dataset);
    EXPECT_EQ(H5Tget_strpad(type), H5T_STR_NULLTERM);
    std::string value(H5Tget_size(type), '\0');
    EXPECT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()), 0) << name;
    H5Tclose(type);
    H5Dclose(dataset);
    return value.c_str();
  }
  std::filesystem::path path_;
  hid_t file_ = -1;
};

TEST_F(FclibFile, HoldsTheProblemInTheDocumentedLayout) {
  const FrictionalContactSolution solution{Eigen::Vector4d(1, 2, 3, 4),
                                           Eigen::Vector4d(5, 6, 7, 8)};
  write_fclib(path_, example(), {"title", "what it is", ""}, &solution);
  open();
  EXPECT_THAT(ints("/fclib_local/spacedim"), ElementsAre(2));
  EXPECT_THAT(ints("/fclib_local/W/nzmax"), ElementsAre(16));
  EXPECT_THAT(ints("/fclib_local/W/m"), ElementsAre(4));
  EXPECT_THAT(ints("/fclib_local/W/n"), ElementsAre(4));
  EXPECT_THAT(ints("/fclib_local/W/nz"), ElementsAre(-1));
  EXPECT_THAT(ints("/fclib_local/W/p"), ElementsAre(0, 4, 8, 12, 16));
  EXPECT_THAT(ints("/fclib_local/W/i"),
              ElementsAre(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3));
  EXPECT_THAT(doubles("/fclib_local/W/x"),
              ElementsAre(4, 1, 0, 2, 1, 5, 3, 0, 0, 3, 6, 1, 2, 0, 1, 7));
  EXPECT_THAT(doubles("/fclib_local/vectors/q"), ElementsAre(-1, 2, -3, 4));
  EXPECT_THAT(doubles("/fclib_local/vectors/mu"), ElementsAre(0.1, 0.2));
  EXPECT_EQ(text("/fclib_local/info/title"), "title");
  EXPECT_EQ(text("/fclib_local/info/description"), "what it is");
  EXPECT_EQ(text("/fclib_local/info/math_info"), "");
  EXPECT_THAT(doubles("/solution/u"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(doubles("/solution/r"), ElementsAre(5, 6, 7, 8));
  EXPECT_THAT(doubles("/faultsim/displacement_unit"), ElementsAre(0.01));
  EXPECT_THAT(doubles("/faultsim/force_unit"), ElementsAre(1e9));
}

TEST_F(FclibFile, HasNoSolutionWhenNoneIsGiven) {
  write_fclib(path_, example(), {"title", "", ""}, nullptr);
  open();
  EXPECT_EQ(H5Lexists(file_, "/solution", H5P_DEFAULT), 0);
}

TEST_F(FclibFile, HasTheSameBytesForTheSameProblem) {
  const auto bytes = [&] {
    write_fclib(path_, example(), {"title", "", ""}, nullptr);
    std::ostringstream out;
    out << std::ifstream(path_, std::ios::binary).rdbuf();
    return out.str();
  };
  const std::string first = bytes();
  EXPECT_GT(first.size(), 1000U);
  EXPECT_TRUE(bytes() == first);
}

TEST_F(FclibFile, IsRefusedOnABadPathAndForBadNumbers) {
  EXPECT_THROW(write_fclib("/dev/null/x.hdf5", example(), {}, nullptr), StorageError);
  FrictionalContactProblem problem = example();
  problem.q[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_fclib(path_, problem, {}, nullptr), InternalError);
  problem = example();
  problem.friction.resize(1);
  EXPECT_THROW(write_fclib(path_, problem, {}, nullptr), InternalError);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace faultsim
