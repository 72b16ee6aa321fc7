#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign/expansion/expansion.h"
#include "campaign/spec/spec.h"
#include "simulator/documents/json_document.h"

/// The choices that trade accuracy for speed, on one scene (docs/tradeoff.md).
namespace faultsweep {

/// One way to model the scene.
struct TradeChoice {
  std::string name;             ///< "20 m"; unique in its axis.
  std::vector<Change> changes;  ///< of the scene document.
  double size = 0;              ///< what is refined: cell size, m, or step, s; 0 where nothing is.
  bool plane_strain = false;
  long n_unknowns = 0, n_jump = 0;
  double predicted_seconds = 0;  ///< of the operator, on one core.
  double predicted_bytes = 0;    ///< peak.
  std::string left_out;          ///< why it is not run; "" = it is.
};

/// Choices that differ in one thing only, all else being equal.
struct TradeAxis {
  std::string name;      ///< "cells, 3D".
  std::string question;  ///< "What do coarser cells cost in 3D?"
  /// Sizes fall by factors of two at the end of the list, so that the limit can be extrapolated.
  bool converges = false;
  bool is_mesh =
      false;  ///< a model of the whole scene, with its cost: a point of the Pareto front.
  std::string reference;  ///< else the choice that errors are against; "" = the last that was run.
  std::vector<TradeChoice> choices;  ///< from cheap to expensive.
};

struct LadderLimits {
  double operator_seconds = 300;  ///< predicted, of one choice.
  double memory_bytes = 0;        ///< predicted peak; 0 = not limited.
};

/// The axes that mean something for the scene: cells in plane strain and in 3D, half domain, domain
/// size, load steps, steps of salt, tolerance of contact, B-bar, activation length. Choices that
/// the scene refuses or that are beyond the limits are there, with the reason.
/// Throws InputError when the scene itself is wrong.
std::vector<TradeAxis> make_ladder(const faultsim::JsonDocument& scene, const LadderLimits& limits);

/// The spec of a campaign that runs them: a group per axis with one parameter, `choice`.
/// @param name  of the campaign.
nlohmann::json ladder_spec(const std::string& name, const faultsim::JsonDocument& scene,
                           const std::vector<TradeAxis>& axes);

/// The group of a ladder's campaign that has the sample at a tier.
std::string sample_group(const std::string& tier);

/// Adds a group per tier to the spec of a ladder, each with the same cases of a campaign: at most
/// n_cases, scattered over its design, with the mesh of the tier instead of their own.
/// @param base  the scene that the spec's cases are changes of.
void add_sample(const Expansion& campaign, const nlohmann::json& base, long n_cases,
                const std::vector<std::string>& tiers, nlohmann::json& spec);

}  // namespace faultsweep
