#include "simulator/elasticity/element.h"

#include <Eigen/LU>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr std::array<std::array<double, 3>, 8> kCorners = {{{-1, -1, -1},
                                                            {1, -1, -1},
                                                            {1, 1, -1},
                                                            {-1, 1, -1},
                                                            {-1, -1, 1},
                                                            {1, -1, 1},
                                                            {1, 1, 1},
                                                            {-1, 1, 1}}};

/// dN_a/dξ_i at the Gauss points, which sit at the corners divided by √3.
std::array<Eigen::Matrix<double, 8, 3>, 8> reference_gradients() {
  std::array<Eigen::Matrix<double, 8, 3>, 8> result;
  for (std::size_t g = 0; g < 8; ++g) {
    for (int a = 0; a < 8; ++a) {
      const auto& corner = kCorners[a];
      std::array<double, 3> factor;
      for (std::size_t i = 0; i < 3; ++i) {
        factor[i] = 1 + corner[i] * kCorners[g][i] / std::sqrt(3.0);
      }
      result[g].row(a) << corner[0] * factor[1] * factor[2] / 8,
          corner[1] * factor[0] * factor[2] / 8, corner[2] * factor[0] * factor[1] / 8;
    }
  }
  return result;
}

/// dN_a/dξ_i of the quadratic tetrahedron, at points one of whose barycentric coordinates is
/// larger.
std::array<Eigen::Matrix<double, 10, 3>, 4> tetrahedron_gradients() {
  Eigen::Matrix<double, 4, 3> barycentric;  // their gradients
  barycentric << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const double small = (5 - std::sqrt(5.0)) / 20, large = 1 - 3 * small;
  std::array<Eigen::Matrix<double, 10, 3>, 4> result;
  for (int g = 0; g < 4; ++g) {
    const auto at = [&](int k) { return k == g ? large : small; };
    auto& gradient = result[static_cast<std::size_t>(g)];
    for (int a = 0; a < 4; ++a) gradient.row(a) = (4 * at(a) - 1) * barycentric.row(a);
    for (int side = 0; side < 6; ++side) {
      const auto a = static_cast<int>(kTetrahedronSides[static_cast<std::size_t>(side)][0]),
                 b = static_cast<int>(kTetrahedronSides[static_cast<std::size_t>(side)][1]);
      gradient.row(4 + side) = 4 * (at(a) * barycentric.row(b) + at(b) * barycentric.row(a));
    }
  }
  return result;
}

/// An isoparametric cell whose Gauss points all have this weight.
template <int Nodes, std::size_t Points>
CellElement<Nodes, static_cast<int>(Points)> isoparametric(
    const std::array<Eigen::Vector3d, static_cast<std::size_t>(Nodes)>& nodes,
    const std::array<Eigen::Matrix<double, Nodes, 3>, Points>& reference, double weight) {
  // Relative to the first node, so that far coordinates cost no digits.
  const Eigen::Vector3d& origin = nodes[0];
  Eigen::Matrix<double, Nodes, 3> places;
  for (int a = 0; a < Nodes; ++a)
    places.row(a) = (nodes[static_cast<std::size_t>(a)] - origin).transpose();
  CellElement<Nodes, static_cast<int>(Points)> element;
  element.mean_gradient.setZero();
  for (std::size_t g = 0; g < Points; ++g) {
    const Eigen::Matrix3d jacobian = places.transpose() * reference[g];  // dx_i/dξ_j
    const double volume = weight * jacobian.determinant();
    FAULTSIM_DEMAND(volume > 0, "the cell at ", origin.transpose(), " is inverted");
    element.gradient[g] = reference[g] * jacobian.inverse();
    element.weight[g] = volume;
    element.volume += volume;
    element.mean_gradient += volume * element.gradient[g];
  }
  element.mean_gradient /= element.volume;
  return element;
}

}  // namespace

double shear_modulus(const ElasticMaterial& material) {
  return material.youngs_modulus / (2 * (1 + material.poisson_ratio));
}

Element make_hexahedron(const std::array<Eigen::Vector3d, 8>& nodes) {
  static const auto kReference = reference_gradients();
  return isoparametric<8>(nodes, kReference, 1);
}

Tetrahedron make_tetrahedron(const std::array<Eigen::Vector3d, 10>& nodes) {
  static const auto kReference = tetrahedron_gradients();
  return isoparametric<10>(nodes, kReference, 1.0 / 24);
}

double volume_of(const Mesh& mesh, int cell) {
  double volume = 0;
  with_element(mesh, cell, [&](const auto& element) { volume = element.volume; });
  return volume;
}

template <int Nodes, int Points>
CellMatrix<Nodes> element_stiffness(const CellElement<Nodes, Points>& element,
                                    const ElasticMaterial& material, bool mean_dilatation) {
  const double mu = shear_modulus(material) * material.shear_factor;
  const double bulk = material.youngs_modulus / (3 * (1 - 2 * material.poisson_ratio));
  // Deviatoric part point by point, bulk modulus on the mean dilatation.
  const double lambda = mean_dilatation ? -2 * mu / 3 : bulk - 2 * mu / 3;
  const double mean = mean_dilatation ? bulk * element.volume : 0;
  CellMatrix<Nodes> k;
  for (Eigen::Index a = 0; a < Nodes; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      Eigen::Matrix3d block =
          mean * element.mean_gradient.row(a).transpose() * element.mean_gradient.row(b);
      for (std::size_t g = 0; g < element.weight.size(); ++g) {
        const Eigen::Vector3d grad_a = element.gradient[g].row(a);
        const Eigen::Vector3d grad_b = element.gradient[g].row(b);
        const Eigen::Matrix3d outer = grad_a * grad_b.transpose();
        Eigen::Matrix3d point = lambda * outer + mu * outer.transpose();
        point.diagonal().array() += mu * outer.trace();
        block += element.weight[g] * point;
      }
      k.template block<3, 3>(3 * a, 3 * b) = block;
    }
  }
  k.template triangularView<Eigen::StrictlyUpper>() = k.transpose();
  return k;
}

template ElementMatrix element_stiffness(const Element&, const ElasticMaterial&, bool);
template CellMatrix<10> element_stiffness(const Tetrahedron&, const ElasticMaterial&, bool);

}  // namespace faultsim
