#pragma once

#include <Eigen/Core>
#include <array>
#include <iosfwd>
#include <vector>

#include "simulator/contact/contact.h"

namespace faultsim {

/// A smooth field over the faults, amplitude cos(π (m ξ + phase/8)) cos(π n η), ξ along strike and
/// η along dip in [0, 1].
struct WaveDraw {
  int amplitude = 0;  ///< in the unit of its user.
  int m = 0, n = 0, phase = 0;
};

struct FrictionDraw {
  bool coefficient = false;  ///< the law.
  bool cumulated = false;
  int angle = 0;         ///< φ_s, deg, 0 to 60.
  int weakening = 0;     ///< (φ_s − φ_d)/φ_s, percent.
  int log_distance = 0;  ///< d_c = 10^(−x/10) m, 0 to 60.
  int cohesion = 0;      ///< 0.1 MPa, 0 to 100.
  bool keep_cohesion = false;
  bool lose_cohesion_slipping = false;
};

/// Locked traction of a load step as what is added to the initial one, all in 0.1 MPa.
struct LoadDraw {
  std::array<int, 3> pressure = {0, 0, 0};  ///< per column of FaultOperator::locked.
  int fault_pressure = 0;                   ///< pushes the faults open.
  WaveDraw normal, strike, dip;
  int rough = 0;  ///< amplitude of what differs at random from node to node.
};

/// One small scene on a real operator. All draws are integers whose simplest value is 0, so that a
/// scene that fails shrinks to one that a person can read.
struct RandomScene {
  int op = 0;                            ///< into stress_operators().
  std::array<FrictionDraw, 2> friction;  ///< of faults 0, 2, ... and 1, 3, ...
  int compression = 0;                   ///< initial −t'_N, 0.1 MPa.
  WaveDraw normal;          ///< percent of that; beyond 100 parts are in tension at first.
  int shear = 0;            ///< initial |t'_T|, percent of the static strength under `compression`.
  int shear_direction = 0;  ///< of 8.
  WaveDraw shear_wave;      ///< percent of `shear`.
  int salt = 0;             ///< of the random fields.
  bool follows = false;     ///< damping is on.
  int onset = 0;            ///< 0: located to 1e-2 of a step, 1: to 1/1024.
  std::vector<LoadDraw> loads;
};

/// Draws a scene. @pre called inside a RapidCheck property.
RandomScene draw_scene();

/// The draw as text, and what it amounts to.
std::ostream& operator<<(std::ostream& out, const RandomScene& scene);

ContactLaws laws_of(const RandomScene& scene, const FaultOperator& op);
ContactOptions options_of(const RandomScene& scene);
/// t_L at the end of each load step, Pa; the first is the initial traction. The history starts at
/// 0.
std::vector<Eigen::VectorXd> locked_tractions(const RandomScene& scene, const FaultOperator& op);

}  // namespace faultsim
