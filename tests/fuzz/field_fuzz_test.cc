#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <random>

#include "simulator/flow/flow_mapping.h"

/// Random corner-point fields on random cells of ours: layers that dip, bend, are thrown against
/// each other and pinch out, in either handedness, inside of a mesh whose inner nodes lie anywhere.
/// Whatever they are, no volume and no pressure is lost or made. Tries fields 0, 1, 2, ... up to
/// FAULTSIM_FUZZ_TABLES (default 100).
namespace faultsim {
namespace {

class Draws {
 public:
  explicit Draws(unsigned long seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int from_to(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

 private:
  std::mt19937_64 engine_;
};

/// VTK's corner q of a cell: 0 or 1 along x, y, z.
int along_x(int q) { return q % 4 == 1 || q % 4 == 2; }
int along_y(int q) { return q % 4 >= 2; }
int along_z(int q) { return q >= 4; }

/// Volume of a hexahedron as the sum over its six faces, each two triangles, of cones from
/// corner 6; faces are cut by the diagonals that meet in corner 0 or 6, as flow_field.h has them.
double volume_by_faces(const CellCorners& c) {
  static constexpr int kTriangles[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                            {0, 1, 5}, {0, 5, 4}, {3, 7, 6}, {3, 6, 2},
                                            {0, 4, 7}, {0, 7, 3}, {1, 2, 6}, {1, 6, 5}};
  double volume = 0;
  for (const auto& t : kTriangles)
    volume += (c[t[0]] - c[6]).dot((c[t[1]] - c[6]).cross(c[t[2]] - c[6])) / 6;
  return std::abs(volume);
}

/// Rising places between 0 and 100 m.
std::vector<double> places(int n, Draws& draws) {
  std::vector<double> at{draws.between(1, 20)};
  for (int i = 0; i < n; ++i) at.push_back(at.back() + draws.between(2, 79.0 / n));
  return at;
}

/// Columns between upright pillars; the layers of a column share their faces, columns may be thrown
/// against each other, and a layer may pinch out at some corners.
FlowField random_field(Draws& draws) {
  const int nx = draws.from_to(1, 3), ny = draws.from_to(1, 2), nz = draws.from_to(1, 3);
  const std::vector<double> x = places(nx, draws), y = places(ny, draws);
  const double dip = draws.between(-0.2, 0.2), thrown = draws.from_to(0, 1) * 9.0;
  const bool mirrored = draws.from_to(0, 1) == 1;
  FlowField field;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      double top[4];  // of the layer below, at the pillars
      for (int p = 0; p < 4; ++p) top[p] = 30 + dip * x[i + along_x(p)] + thrown * i;
      for (int k = 0; k < nz; ++k) {
        CellCorners corners;
        for (int q = 0; q < 8; ++q) {
          if (q == 4) {
            for (double& z : top) z += draws.from_to(0, 4) == 0 ? 0 : draws.between(0.5, 30.0 / nz);
          }
          corners[q] = {x[i + along_x(q)], y[j + along_y(q)], top[q % 4]};
        }
        if (mirrored) {  // corners in the order of a left-handed cell that fills the same
          std::swap(corners[1], corners[3]);
          std::swap(corners[5], corners[7]);
        }
        const FlowCell cell = flow_cell_around(corners);
        if ((cell.high - cell.low).minCoeff() > 0) field.cells.push_back(cell);
      }
    }
  }
  field.date = {0};
  field.value.resize(std::ssize(field.cells), 1);
  for (double& pressure : field.value.reshaped()) pressure = draws.between(1e6, 4e7);
  return field;
}

/// Cells that fill [0, 100]³ m; inner nodes anywhere within a fifth of a cell of a lattice.
std::vector<MappedCell> random_cells(Draws& draws) {
  const int n = draws.from_to(1, 3);
  std::vector<Eigen::Vector3d> nodes;
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        Eigen::Vector3d node(i, j, k);
        for (double& u : node) u = u > 0 && u < n ? u + draws.between(-0.2, 0.2) : u;
        nodes.push_back(100.0 / n * node);
      }
    }
  }
  std::vector<MappedCell> cells;
  for (int c = 0; c < n * n * n; ++c) {
    MappedCell cell{.corners = {}, .region = c % 2, .fraction = 1};
    for (int q = 0; q < 8; ++q) {
      const int i = c % n + along_x(q), j = c / n % n + along_y(q), k = c / n / n + along_z(q);
      cell.corners[q] = nodes[(k * (n + 1) + j) * (n + 1) + i];
    }
    cells.push_back(cell);
  }
  return cells;
}

TEST(FieldFuzz, LosesNeitherVolumeNorPressure) {
  const char* wanted = std::getenv("FAULTSIM_FUZZ_TABLES");
  const long n_fields = wanted == nullptr ? 100 : std::atol(wanted);
  for (long seed = 0; seed < n_fields && !HasFailure(); ++seed) {
    Draws draws(static_cast<unsigned long>(seed));
    const FlowField field = random_field(draws);
    if (field.cells.empty()) continue;
    const std::vector<MappedCell> cells = random_cells(draws);
    const FlowMapping mapping =
        map_flow(field, cells, {"west", "east"}, {.outside = OutsideRule::unchanged});
    FlowField from_zero = field;
    from_zero.value = Eigen::MatrixXd::Zero(field.value.rows(), 2);
    from_zero.value.col(1) = field.value.col(0);
    const Eigen::VectorXd pressure = mapped_change(mapping, from_zero, 0, {1}).col(0);
    double volume = 0, integral = 0, covered = 0, found = 0;
    for (std::size_t f = 0; f < field.cells.size(); ++f) {
      const FlowCell& cell = field.cells[f];
      const double own =
          cell.corners ? volume_by_faces(*cell.corners) : (cell.high - cell.low).prod();
      volume += own;
      integral += own * field.value(static_cast<Eigen::Index>(f), 0);
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double part = mapping.covered[c] * volume_by_faces(cells[c].corners);
      covered += part;
      found += part * pressure[static_cast<Eigen::Index>(c)];
    }
    EXPECT_NEAR(covered, volume, 1e-9 * 1e6) << "field " << seed;
    EXPECT_NEAR(found, integral, 1e-9 * 1e6 * 4e7) << "field " << seed;
    EXPECT_NEAR(mapping.coverage[0].covered +
                    (mapping.coverage.size() > 1 ? mapping.coverage[1].covered : 0),
                volume, 1e-9 * 1e6)
        << "field " << seed;
  }
}

}  // namespace
}  // namespace faultsim
