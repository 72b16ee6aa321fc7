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

}  // namespace

double shear_modulus(const ElasticMaterial& material) {
  return material.youngs_modulus / (2 * (1 + material.poisson_ratio));
}

Element make_element(const Mesh& mesh, int cell) {
  static const auto kReference = reference_gradients();
  Eigen::Matrix<double, 8, 3> corners;
  const auto& nodes = mesh.cells[cell];
  // Relative to the first corner, so that far coordinates cost no digits.
  const Eigen::Vector3d origin = mesh.nodes[nodes[0]];
  for (int a = 0; a < 8; ++a) {
    const int node = nodes[a];
    corners.row(a) = (mesh.nodes[node] - origin).transpose();
  }
  Element element;
  element.mean_gradient.setZero();
  for (std::size_t g = 0; g < 8; ++g) {
    const Eigen::Matrix3d jacobian = corners.transpose() * kReference[g];  // dx_i/dξ_j
    const double determinant = jacobian.determinant();
    FAULTSIM_DEMAND(determinant > 0, "cell ", cell, " at ", origin.transpose(), " is inverted");
    element.gradient[g] = kReference[g] * jacobian.inverse();
    element.weight[g] = determinant;
    element.volume += determinant;
    element.mean_gradient += determinant * element.gradient[g];
  }
  element.mean_gradient /= element.volume;
  return element;
}

ElementMatrix element_stiffness(const Element& element, const ElasticMaterial& material,
                                bool b_bar) {
  const double mu = shear_modulus(material) * material.shear_factor;
  const double bulk = material.youngs_modulus / (3 * (1 - 2 * material.poisson_ratio));
  // With B-bar: deviatoric part point by point, bulk modulus on the mean dilatation.
  const double lambda = b_bar ? -2 * mu / 3 : bulk - 2 * mu / 3;
  const double mean = b_bar ? bulk * element.volume : 0;
  ElementMatrix k;
  for (Eigen::Index a = 0; a < 8; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      Eigen::Matrix3d block =
          mean * element.mean_gradient.row(a).transpose() * element.mean_gradient.row(b);
      for (std::size_t g = 0; g < 8; ++g) {
        const Eigen::Vector3d grad_a = element.gradient[g].row(a);
        const Eigen::Vector3d grad_b = element.gradient[g].row(b);
        const Eigen::Matrix3d outer = grad_a * grad_b.transpose();
        Eigen::Matrix3d point = lambda * outer + mu * outer.transpose();
        point.diagonal().array() += mu * outer.trace();
        block += element.weight[g] * point;
      }
      k.block<3, 3>(3 * a, 3 * b) = block;
    }
  }
  k.triangularView<Eigen::StrictlyUpper>() = k.transpose();
  return k;
}

}  // namespace faultsim
