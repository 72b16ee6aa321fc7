#include "tests/stress/random_scene.h"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <ostream>

#include "tests/stress/stress_operators.h"

namespace faultsim {
namespace {

constexpr double kUnit = 1e5;  // Pa, of the draws

/// Uniform in [low, high] whatever RapidCheck's size; shrinks towards low.
int whole(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1));
}
bool one_in(int n) { return whole(0, n - 1) == n - 1; }
/// Uniform in [−limit, limit]; shrinks towards 0.
int either_sign(int limit) {
  const int size = whole(0, limit);
  return one_in(2) ? -size : size;
}

WaveDraw draw_wave(int limit) {
  WaveDraw wave;
  if (!one_in(2)) return wave;
  wave.amplitude = either_sign(limit);
  wave.m = whole(0, 3);
  wave.n = whole(0, 5);
  wave.phase = whole(0, 7);
  return wave;
}

FrictionDraw draw_friction() {
  FrictionDraw draw;
  draw.coefficient = one_in(2);
  draw.cumulated = one_in(2);
  draw.angle = one_in(8) ? 0 : whole(0, 60);
  if (one_in(2)) {
    draw.weakening = whole(0, 100);
    draw.log_distance = whole(0, 60);
  }
  if (one_in(2)) draw.cohesion = whole(0, 100);
  draw.keep_cohesion = one_in(2);
  draw.lose_cohesion_slipping = one_in(3);
  return draw;
}

LoadDraw draw_load() {
  LoadDraw load;
  for (int& pressure : load.pressure) {
    if (one_in(2)) pressure = either_sign(300);
  }
  if (one_in(4)) load.fault_pressure = whole(0, 700);
  load.normal = draw_wave(150);
  load.strike = draw_wave(150);
  load.dip = draw_wave(150);
  if (one_in(4)) load.rough = whole(0, 100);
  return load;
}

/// Where the nodes lie within the box around all of them, in [0, 1]².
std::vector<Eigen::Vector2d> places(const FaultOperator& op) {
  Eigen::Vector2d low(1e30, 1e30), high(-1e30, -1e30);
  for (const OperatorNode& node : op.geometry.nodes) {
    low = low.cwiseMin(node.position.tail<2>());
    high = high.cwiseMax(node.position.tail<2>());
  }
  const Eigen::Vector2d extent = (high - low).cwiseMax(1.0);
  std::vector<Eigen::Vector2d> places;
  for (const OperatorNode& node : op.geometry.nodes) {
    places.push_back((node.position.tail<2>() - low).cwiseQuotient(extent));
  }
  return places;
}

double value(const WaveDraw& wave, const Eigen::Vector2d& at) {
  if (wave.amplitude == 0) return 0;
  return wave.amplitude * std::cos(std::numbers::pi * (wave.m * at[0] + wave.phase / 8.0)) *
         std::cos(std::numbers::pi * wave.n * at[1]);
}

/// In [−1, 1], without the state of a random engine: SplitMix64.
double noise(int salt, std::size_t step, int dof) {
  std::uint64_t x = static_cast<std::uint64_t>(salt) * 0x9e3779b97f4a7c15ULL + step * 1000003ULL +
                    static_cast<std::uint64_t>(dof);
  for (const std::uint64_t factor : {0xbf58476d1ce4e5b9ULL, 0x94d049bb133111ebULL}) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * factor;
  }
  return static_cast<double>(x >> 11) / static_cast<double>(1ULL << 52) - 1;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

std::size_t draw_of_fault(std::size_t fault) { return fault % 2; }

/// Fault of each node.
std::vector<std::size_t> fault_of_nodes(const FaultOperator& op) {
  std::vector<std::size_t> fault(op.geometry.nodes.size());
  for (std::size_t f = 0; f < op.geometry.faults.size(); ++f) {
    const OperatorFault& of = op.geometry.faults[f];
    std::fill_n(fault.begin() + of.first_node, of.n_nodes, f);
  }
  return fault;
}

void add(Eigen::VectorXd& locked, int dof, double traction) {
  if (dof >= 0) locked[dof] += traction;
}

Eigen::VectorXd initial(const RandomScene& scene, const FaultOperator& op) {
  Eigen::VectorXd locked = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  const std::vector<Eigen::Vector2d> at = places(op);
  const std::vector<std::size_t> fault = fault_of_nodes(op);
  const double angle = std::numbers::pi / 4 * scene.shear_direction;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const FrictionDraw& friction = scene.friction[draw_of_fault(fault[k])];
    const double strength =
        kUnit * (friction.cohesion + scene.compression * std::tan(radians(friction.angle)));
    const double shear = strength * scene.shear / 100 * (1 + value(scene.shear_wave, at[k]) / 100);
    const auto& dof = op.geometry.nodes[k].dof;
    add(locked, dof[0], -kUnit * scene.compression * (1 + value(scene.normal, at[k]) / 100));
    add(locked, dof[1], shear * std::sin(angle));
    add(locked, dof[2], shear * std::cos(angle));
  }
  return locked;
}

}  // namespace

RandomScene draw_scene() {
  RandomScene scene;
  // The last operator is the largest by far and costs as much as all others together.
  const int n_small = static_cast<int>(stress_operators().size()) - 1;
  scene.op = one_in(100) ? n_small : whole(0, n_small - 1);
  for (FrictionDraw& friction : scene.friction) friction = draw_friction();
  scene.compression = whole(0, 600);
  scene.normal = draw_wave(130);
  scene.shear = whole(0, 150);
  scene.shear_direction = whole(0, 7);
  scene.shear_wave = draw_wave(100);
  scene.salt = whole(0, 1000);
  scene.follows = !one_in(4);
  scene.onset = one_in(16) ? 1 : 0;
  // The steps are drawn alike but unloading and reversal are asked for, not left to chance.
  const int n_steps = whole(3, 8);
  for (int i = 0; i < n_steps; ++i) {
    const int kind = whole(0, 5);
    if (kind == 1) {
      scene.loads.emplace_back();
    } else if (kind == 2 && i > 1) {
      scene.loads.push_back(scene.loads[static_cast<std::size_t>(i - 2)]);
    } else {
      scene.loads.push_back(draw_load());
    }
  }
  return scene;
}

ContactLaws laws_of(const RandomScene& scene, const FaultOperator& op) {
  ContactLaws laws;
  const std::vector<std::size_t> fault = fault_of_nodes(op);
  for (const std::size_t f : fault) {
    const FrictionDraw& draw = scene.friction[draw_of_fault(f)];
    CoulombLaw law;
    law.weakening = draw.coefficient ? WeakeningLaw::coefficient : WeakeningLaw::angle;
    law.cohesion = draw.cohesion * kUnit;
    law.static_friction_angle = radians(draw.angle);
    law.dynamic_friction_angle = law.static_friction_angle * (100 - draw.weakening) / 100;
    law.slip_weakening_distance = std::pow(10.0, -draw.log_distance / 10.0);
    law.slip_measure = draw.cumulated ? SlipMeasure::cumulated : SlipMeasure::current;
    law.cohesion_after_opening = draw.keep_cohesion;
    law.cohesion_after_slip = !draw.lose_cohesion_slipping;
    if (scene.follows) {
      law.damping = 0.5 * std::sqrt(2500 * op.geometry.nodes[laws.size()].effective_shear_modulus);
    }
    laws.push_back(law);
  }
  return laws;
}

ContactOptions options_of(const RandomScene& scene) {
  ContactOptions options;
  options.onset_tolerance = scene.onset == 0 ? 1e-2 : 1.0 / 1024;
  options.max_iterations = 400'000;  // ten times the most that was ever needed
  return options;
}

std::vector<Eigen::VectorXd> locked_tractions(const RandomScene& scene, const FaultOperator& op) {
  std::vector<Eigen::VectorXd> locked = {initial(scene, op)};
  const std::vector<Eigen::Vector2d> at = places(op);
  for (std::size_t step = 0; step < scene.loads.size(); ++step) {
    const LoadDraw& load = scene.loads[step];
    Eigen::VectorXd now = locked[0];
    for (Eigen::Index j = 0; j < op.loads.traction.cols(); ++j) {
      now += kUnit * load.pressure[static_cast<std::size_t>(j) % load.pressure.size()] *
             op.loads.traction.col(j);
    }
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto& dof = op.geometry.nodes[k].dof;
      const std::array<double, 3> push = {load.fault_pressure + value(load.normal, at[k]),
                                          value(load.strike, at[k]), value(load.dip, at[k])};
      for (std::size_t c = 0; c < 3; ++c) {
        add(now, dof[c], kUnit * (push[c] + load.rough * noise(scene.salt, step, dof[c])));
      }
    }
    locked.push_back(std::move(now));
  }
  return locked;
}

namespace {

std::ostream& operator<<(std::ostream& out, const WaveDraw& wave) {
  out << wave.amplitude;
  if (wave.amplitude == 0) return out;
  return out << " cos(pi (" << wave.m << " xi + " << wave.phase << "/8)) cos(pi " << wave.n
             << " eta)";
}

std::ostream& operator<<(std::ostream& out, const FrictionDraw& draw) {
  out << "angle " << draw.angle << " deg, cohesion " << draw.cohesion / 10.0 << " MPa"
      << (draw.keep_cohesion ? ", kept when opening" : "")
      << (draw.lose_cohesion_slipping ? ", lost by slip" : "");
  if (draw.weakening == 0) return out;
  return out << ", weakens by " << draw.weakening << " % over 1e-" << draw.log_distance / 10.0
             << " m" << (draw.coefficient ? ", coefficient" : ", angle")
             << (draw.cumulated ? ", cumulated" : ", current");
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const RandomScene& scene) {
  const StressOperator& on = stress_operators()[static_cast<std::size_t>(scene.op)];
  out << "operator " << scene.op << " (" << on.name << ", " << on.op->geometry.nodes.size()
      << " nodes), damping " << (scene.follows ? "on" : "off") << ", onset " << scene.onset
      << ", salt " << scene.salt << "\n  friction 0: " << scene.friction[0]
      << "\n  friction 1: " << scene.friction[1] << "\n  start: compression "
      << scene.compression / 10.0 << " MPa (1 + " << scene.normal << " %), shear " << scene.shear
      << " % of strength (1 + " << scene.shear_wave << " %), direction " << scene.shear_direction
      << "/8";
  for (const LoadDraw& load : scene.loads) {
    out << "\n  load [0.1 MPa]: pressure " << load.pressure[0] << ' ' << load.pressure[1] << ' '
        << load.pressure[2] << ", fault pressure " << load.fault_pressure << ", normal "
        << load.normal << ", strike " << load.strike << ", dip " << load.dip << ", rough "
        << load.rough;
  }
  return out;
}

}  // namespace faultsim
