#include "simulator/loading/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/linalg/dense_cholesky.h"

namespace faultsim {
namespace {

std::string two_digits(double value) { return formatted("%.2g", value); }

void note_change(NoiseCheck& noise, const char* what, const std::string& from,
                 const std::string& to) {
  if (from != to) noise.changed.push_back(concat(what, " ", from, " -> ", to));
}

std::string activation(const CaseResult& result) {
  if (!result.whole.activated) return "none";
  return concat(result.whole.activated_fault, " in step ", *result.whole.activation_step);
}

/// Whether the result says itself that its numbers depend on the mesh, or that it has no end.
bool outcome_tells(Outcome outcome) {
  return outcome != Outcome::converged && outcome != Outcome::event;
}

}  // namespace

OperatorCheck check_operator(const FaultOperator& op) {
  OperatorCheck check;
  const auto h = op.h();
  const double largest = h.size() > 0 ? h.cwiseAbs().maxCoeff() : 0;
  if (largest > 0) check.asymmetry = (h - h.transpose()).cwiseAbs().maxCoeff() / largest;
  const Eigen::VectorXd root = op.geometry.dof_area.cwiseSqrt().cwiseInverse();
  check.condition = spd_condition(root.asDiagonal() * h * root.asDiagonal());
  return check;
}

NoiseCheck compare_with_twin(const CaseResult& result, const CaseResult& twin) {
  NoiseCheck noise;
  note_change(noise, "outcome", to_string(result.outcome), to_string(twin.outcome));
  note_change(noise, "activation", activation(result), activation(twin));
  note_change(noise, "events", concat(result.events.size()), concat(twin.events.size()));
  double largest = 0, change = 0;
  for (std::size_t i = 0; i < std::min(result.steps.size(), twin.steps.size()); ++i) {
    const auto& faults = result.steps[i].faults;
    const auto& twins = twin.steps[i].faults;
    for (std::size_t f = 0; f < std::min(faults.size(), twins.size()); ++f) {
      const double chi = std::abs(faults[f].chi_bar - twins[f].chi_bar);
      noise.chi_bar_change = std::max(noise.chi_bar_change, chi / std::max(1.0, faults[f].chi_bar));
      largest = std::max(largest, faults[f].max_slip);
      change = std::max(change, std::abs(faults[f].max_slip - twins[f].max_slip));
    }
  }
  // Slips that no criterion sees are no ground to divide by.
  constexpr double kSeen = 1e-6;  // m
  noise.slip_change = change / std::max(largest, kSeen);
  return noise;
}

void judge(const DiagnosisLimits& limits, double traction_tolerance, Diagnosis& diagnosis) {
  diagnosis.violations.clear();
  const auto flag = [&](const std::string& what, bool told) {
    diagnosis.violations.push_back({what, told});
  };
  // What is not a number is beyond every limit.
  const auto limit = [&](const char* what, double value, double most, bool told) {
    if (!(value <= most))
      flag(concat(what, two_digits(value), ", above the limit of ", two_digits(most)), told);
  };
  const CaseResult& result = diagnosis.result;
  const double residual = limits.residual * traction_tolerance / 1e-8;
  limit("a load step misses equilibrium or contact by ", diagnosis.worst.relative.largest(),
        residual, false);
  limit("the energies of a load step miss their identity by ", diagnosis.worst.largest_energy(),
        residual, false);
  if (!(diagnosis.op.asymmetry <= limits.asymmetry))
    flag(concat("H is not symmetric, by ", two_digits(diagnosis.op.asymmetry)), false);
  if (!diagnosis.op.condition) {
    flag("H is not positive definite", false);
  } else {
    limit("H has the condition ", *diagnosis.op.condition, limits.condition, false);
  }
  const bool open_end = outcome_tells(result.outcome);
  limit("noise of 1e-12 changes the answer by ", diagnosis.noise.change(), limits.noise_change,
        open_end);
  for (const std::string& change : diagnosis.noise.changed)
    flag("noise of 1e-12 changes the " + change, open_end);
  const auto n_without = std::ranges::count_if(
      result.events, [](const SlipEvent& event) { return !event.evidence_holds; });
  if (n_without > 0)
    flag(concat("the evidence of ", n_without, " slip events does not hold"), open_end);
}

Diagnosis diagnose_case(const Scene& scene, const PreparedOperator& prepared,
                        const RunContext& context, const DiagnosisLimits& limits) {
  Diagnosis diagnosis;
  diagnosis.op = check_operator(*prepared.op);
  CaseProbe probe;
  probe.accepted = [&](int number, const ContactLaws& laws, const AcceptedStep& step) {
    const Verdict verdict = judge_step(*prepared.op, laws, step);
    if (diagnosis.worst_step < 0 ||
        verdict.relative.largest() > diagnosis.worst.relative.largest()) {
      diagnosis.worst_step = number;
    }
    diagnosis.worst.take_worst(verdict);
    ++diagnosis.n_steps;
    diagnosis.n_elastic += step.elastic;
    diagnosis.n_at_once += step.at_once;
  };
  diagnosis.result = run_case(scene, prepared, context, probe);
  if (diagnosis.result.outcome == Outcome::interrupted) return diagnosis;
  CaseProbe disturbed;
  disturbed.noise = NoiseCheck::kNoise;
  const CaseResult twin = run_case(scene, prepared, context, disturbed);
  if (twin.outcome == Outcome::interrupted) {
    diagnosis.result.outcome = Outcome::interrupted;
    return diagnosis;
  }
  diagnosis.noise = compare_with_twin(diagnosis.result, twin);
  judge(limits, scene.numerics.traction_tolerance, diagnosis);
  return diagnosis;
}

}  // namespace faultsim
