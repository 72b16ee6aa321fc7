#include "simulator/coupled/petsc_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <sstream>
#include <vector>

#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, long>;

/// Reads as PETSc's manual says: big-endian, whatever this processor is.
class PetscReader {
 public:
  explicit PetscReader(std::istream& from) : from_(from) {}
  std::uint64_t bits(int n_bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < n_bytes; ++i) value = value << 8 | static_cast<unsigned char>(from_.get());
    return value;
  }
  int count() { return static_cast<int>(bits(4)); }
  double value() { return std::bit_cast<double>(bits(8)); }

  Eigen::MatrixXd matrix() {
    EXPECT_EQ(count(), 1211216);
    const int n_rows = count(), n_columns = count(), n_entries = count();
    std::vector<int> row_of, column(n_entries);
    for (int i = 0; i < n_rows; ++i) row_of.insert(row_of.end(), count(), i);
    EXPECT_EQ(static_cast<int>(row_of.size()), n_entries);
    for (int& c : column) c = count();
    Eigen::MatrixXd read = Eigen::MatrixXd::Zero(n_rows, n_columns);
    for (int k = 0; k < n_entries; ++k) read(row_of[k], column[k]) = value();
    return read;
  }
  Eigen::VectorXd vector() {
    EXPECT_EQ(count(), 1211214);
    Eigen::VectorXd read(count());
    for (double& x : read) x = value();
    return read;
  }

 private:
  std::istream& from_;
};

TEST(PetscFiles, AreByteForByteWhatTheManualSays) {
  SparseMatrix a(1, 2);
  a.insert(0, 1) = -2;
  a.makeCompressed();
  std::ostringstream file;
  write_petsc(file, RowMatrix(a));
  const unsigned char expected[] = {0, 0x12, 0x7b, 0x50, 0, 0, 0, 1, 0,    0, 0, 2, 0, 0, 0, 1,
                                    0, 0,    0,    1,    0, 0, 0, 1, 0xc0, 0, 0, 0, 0, 0, 0, 0};
  const std::string bytes = file.str();
  EXPECT_THAT(std::vector<unsigned char>(bytes.begin(), bytes.end()),
              testing::ElementsAreArray(expected));
}

TEST(PetscFiles, ReadBackAsTheBlocksOfTheJacobian) {
  const test::CoupledExample example;
  const SaddlePoint j = example.both()[1];  // K + E is not symmetric
  std::stringstream file;
  write_petsc(file, RowMatrix(j.leading()));
  write_petsc(file, RowMatrix(j.coupling));
  write_petsc_transposed(file, j.constraint);
  PetscReader reader(file);
  EXPECT_EQ(reader.matrix(), Eigen::MatrixXd(j.leading()));
  EXPECT_EQ(reader.matrix(), Eigen::MatrixXd(j.coupling));
  EXPECT_EQ(reader.matrix(), Eigen::MatrixXd(j.constraint).transpose());
}

TEST(PetscFiles, HoldVectorsOneAfterAnother) {
  const Eigen::MatrixXd vectors = Eigen::MatrixXd::Random(5, 3);
  std::stringstream file;
  for (int k = 0; k < 3; ++k) write_petsc(file, vectors.col(k));
  PetscReader reader(file);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(reader.vector(), vectors.col(k));
}

}  // namespace
}  // namespace faultsim
