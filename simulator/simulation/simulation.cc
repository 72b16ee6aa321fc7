#include "simulator/simulation/simulation.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "simulator/loading/pressure_warnings.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/simulation/inside.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/operator_build.h"
#include "simulator/simulation/operator_source.h"

namespace faultsim {

using nlohmann::json;

namespace {

using Values = std::vector<PlacedValue>;

}  // namespace

struct Simulation::Impl {
  std::optional<JsonDocument> held;  ///< none: the scene at hand is the one held.
  LoadedScene at_hand;               ///< may be of that base.
  std::string key;                   ///< of the operator that the scene at hand needs.
  CachePolicy cache;
  PreparedOperator prepared;
  std::string prepared_key;
  /// Shared with a build that was called off and has not ended; nobody else looks at it then.
  std::shared_ptr<OperatorSource> operators = std::make_shared<OperatorSource>();
  std::unique_ptr<OperatorBuild> build;        ///< also one that was called off and has not ended.
  std::map<std::string, std::string> aliases;  ///< of `held`, once asked for.

  void take(LoadedScene loaded) {
    at_hand = std::move(loaded);
    key = operator_case_key(at_hand);
  }
  void keep();
  bool change(Values values, const std::string& source);
  std::optional<Values> values_of(const Changes& changes);
};

/// The jumps that a case has moved so far.
class MovedJumps {
 public:
  explicit MovedJumps(const FaultOperator& op)
      : op_(op), moved_(static_cast<std::size_t>(op.geometry.n_dofs), false) {}

  void look(const FaultFields& fields) {
    for (std::size_t k = 0; k < op_.geometry.nodes.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int dof = op_.geometry.nodes[k].dof[c];
        const double jump = fields.jump(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k));
        if (dof >= 0 && jump != 0) moved_[dof] = true;
      }
    }
  }
  std::vector<int> list() const {
    std::vector<int> dofs;
    for (std::size_t d = 0; d < moved_.size(); ++d)
      if (moved_[d]) dofs.push_back(static_cast<int>(d));
    return dofs;
  }

 private:
  const FaultOperator& op_;
  std::vector<bool> moved_;
};

/// What is changed from now on.
void Simulation::Impl::keep() {
  if (held) return;
  held = at_hand.document;
  aliases.clear();
}

/// Throws InputError where the scene is wrong. @returns false where a value has no place in it.
bool Simulation::Impl::change(Values values, const std::string& source) {
  std::optional<LoadedScene> loaded = reload_scene(*held, std::move(values), source, at_hand);
  if (loaded) take(std::move(*loaded));
  return loaded.has_value();
}

/// None where there is something to explain.
std::optional<Values> Simulation::Impl::values_of(const Changes& changes) {
  if (aliases.empty()) aliases = parameter_aliases(*held);
  Values values;
  for (const Change& change : changes) {
    const auto found = aliases.find(change.parameter);
    const std::string& pointer = found != aliases.end() ? found->second : change.parameter;
    if (pointer.size() < 2 || pointer[0] != '/') return std::nullopt;
    values.push_back({pointer, value_of_text(change.value, held->source, pointer)});
  }
  return values;
}

Simulation::Simulation() : impl_(std::make_unique<Impl>()) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation Simulation::from_file(const std::string& file, const Changes& changes, bool exact) {
  Simulation simulation;
  JsonDocument document = read_scene_file(file, changes);
  if (exact && value_at(document.value, "/numerics/surface") != nullptr)
    put_value(document.value, "/numerics/surface/exact", true);
  Inside::hold(simulation, std::move(document));
  LoadedScene& loaded = simulation.impl_->at_hand;
  loaded.plan.warnings = pressure_warnings(loaded.scene);
  return simulation;
}

Simulation Simulation::from_text(std::string_view text, const std::string& source) {
  Simulation simulation;
  simulation.hold_text(text, source);
  return simulation;
}

Simulation Simulation::twin() const {
  const Impl& self = *impl_;
  Simulation other;
  Impl& its = *other.impl_;
  its.held = self.held;
  its.at_hand = self.at_hand;
  its.at_hand.is_of_base = false;
  its.key = self.key;
  its.cache = self.cache;
  if (!self.build) *its.operators = self.operators->for_another_thread();
  const bool is_constant = !self.prepared.bulk && !self.prepared.surface;
  if (!needs_operator() && is_constant) {
    its.prepared = self.prepared;
    its.prepared_key = self.prepared_key;
  }
  return other;
}

void Simulation::keep_operators(const CachePolicy& policy) { impl_->cache = policy; }

void Simulation::hold_text(std::string_view text, const std::string& source) {
  Inside::hold(*this, parse_json(text, source));
}

void Inside::hold(Simulation& simulation, JsonDocument document) {
  hold(simulation, load_scene(std::move(document)));
}

void Inside::hold(Simulation& simulation, LoadedScene loaded) {
  simulation.impl_->take(std::move(loaded));
  simulation.impl_->held.reset();
}

void Inside::hold_base(Simulation& simulation, JsonDocument document) {
  Simulation::Impl& self = *simulation.impl_;
  self.held = std::move(document);
  self.at_hand.is_of_base = false;
  self.aliases.clear();
}

void Simulation::change(const Changes& changes) {
  Impl& self = *impl_;
  self.keep();
  try {
    std::optional<Values> values = self.values_of(changes);
    if (values && self.change(std::move(*values), self.held->source)) return;
  } catch (const InputError&) {  // said again below, with the lines of the file
  }
  JsonDocument document = *self.held;
  apply(changes, document);
  self.take(load_scene(std::move(document)));
  self.at_hand.is_of_base = false;
}

void Inside::change_values(Simulation& simulation, const JsonDocument& values) {
  Simulation::Impl& self = *simulation.impl_;
  self.keep();
  Values all;
  json document = self.held->value;
  for (const auto& [pointer, value] : values.value.items()) all.push_back({pointer, value});
  if (self.change(all, values.source)) return;
  for (const auto& [pointer, value] : all) {
    if (put_value(document, pointer, value)) continue;
    throw InputError(values.source, {{pointer, 0, "the base scene has no place for it", ""}});
  }
}

const LoadedScene& Inside::scene(const Simulation& simulation) { return simulation.impl_->at_hand; }

void Simulation::check() { check_geometry(impl_->at_hand); }

std::string Simulation::plan_text() const { return plan_to_text(impl_->at_hand.plan); }

std::string Simulation::identity() const { return impl_->at_hand.identity; }

bool Simulation::needs_operator() const {
  return !impl_->prepared.op || impl_->prepared_key != impl_->key;
}

bool Simulation::prepare(const RunContext& context, bool keep_bulk) {
  Impl& self = *impl_;
  if (!needs_operator() && (self.prepared.bulk || !keep_bulk)) return false;
  self.prepared = {};  // frees the old operator before the new one is built
  OperatorSource::Made made;
  if (self.build) self.build->wait_for_end(context);  // two would need the memory of both
  context.stop.throw_if_requested("preparing the operator");
  if (self.operators->is_at_hand(self.at_hand, keep_bulk)) {
    made = self.operators->prepare(self.at_hand, self.cache, keep_bulk, context);
  } else {
    self.build = std::make_unique<OperatorBuild>(
        [operators = self.operators, loaded = self.at_hand, cache = self.cache,
         keep_bulk](const RunContext& inner) {
          return operators->prepare(loaded, cache, keep_bulk, inner);
        },
        context.n_threads);
    made = self.build->wait(context);
    self.build.reset();
  }
  self.prepared = std::move(made.prepared);
  self.prepared_key = self.key;
  if (!self.prepared.remark.empty()) context.note(self.prepared.remark);
  return made.is_new;
}

const PreparedOperator& Inside::prepared(const Simulation& simulation) {
  FAULTSIM_DEMAND(!simulation.needs_operator(), "no operator for the scene at hand");
  return simulation.impl_->prepared;
}

std::shared_ptr<const FaultGeometry> Simulation::geometry() const {
  const std::shared_ptr<const FaultOperator>& op = Inside::prepared(*this).op;
  return {op, &op->geometry};
}

std::vector<FaultPoint> Simulation::points() const {
  const FaultGeometry& geometry = Inside::prepared(*this).op->geometry;
  std::vector<FaultPoint> points;
  points.reserve(geometry.nodes.size());
  for (const OperatorFault& fault : geometry.faults) {
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const OperatorNode& node = geometry.nodes[k];
      points.push_back({fault.name, node.position, node.normal, node.strike, node.dip, node.area});
    }
  }
  return points;
}

CaseResult Simulation::run(const RunContext& context, const RunWatch& watch) {
  prepare(context, watch.displaced != nullptr);
  CaseProbe probe{watch};
  probe.identity = impl_->at_hand.identity;
  const PreparedOperator& prepared = impl_->prepared;
  if (!prepared.surface) return run_case(impl_->at_hand.scene, prepared, context, probe);
  MovedJumps moved(*prepared.op);
  probe.step = [&](const StepResult& step, const FaultFields& fields) {
    moved.look(fields);
    if (watch.step) watch.step(step, fields);
  };
  CaseResult result = run_case(impl_->at_hand.scene, prepared, context, probe);
  require_definite(*prepared.op, moved.list());
  return result;
}

CaseResult Simulation::run(const Changes& changes, const RunContext& context,
                           const RunWatch& watch) {
  change(changes);
  return run(context, watch);
}

}  // namespace faultsim
