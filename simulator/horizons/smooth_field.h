#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <vector>

#include "simulator/horizons/map_mesh.h"

namespace faultsim::horizons {

/// direction · u = a value that is known at a vertex.
struct FieldRule {
  Eigen::Vector2d direction;
  int line;            ///< of a fault; −1: a side of the box.
  std::size_t vertex;  ///< of that line.
};

/// Vectors over the map that are as smooth as can be: ∫|Δu|² is least under rules at vertices, two
/// at most, as the places have where a fault meets another or the edge. Where lines meet both hold.
class SmoothField {
 public:
  SmoothField(const MapMesh& map, std::vector<std::vector<FieldRule>> rules);
  const std::vector<FieldRule>& rules(std::size_t vertex) const { return rules_[vertex]; }
  /// The u at a vertex that keeps its rules and has nothing else.
  Eigen::Vector2d fixed(std::size_t vertex, const Eigen::Vector2d& values) const;
  /// @param fixed  per vertex what its rules say, by fixed(); anything where none are.
  std::vector<Eigen::Vector2d> solve(const std::vector<Eigen::Vector2d>& fixed) const;

 private:
  /// u = fixed + basis q, q of as many components as are free.
  struct Freedom {
    Eigen::Matrix2d basis = Eigen::Matrix2d::Identity();
    int n_free = 2;
    int first = 0;  ///< its first unknown.

    explicit Freedom(const std::vector<FieldRule>& rules);
  };

  std::vector<std::vector<FieldRule>> rules_;
  std::vector<Freedom> free_;
  Eigen::SparseMatrix<double> bending_;  ///< ∫ Δφ_i Δφ_j.
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  int n_free_ = 0;
};

}  // namespace faultsim::horizons
