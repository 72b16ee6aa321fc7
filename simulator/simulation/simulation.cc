#include "simulator/simulation/simulation.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "simulator/common/stopwatch.h"
#include "simulator/loading/pressure_warnings.h"
#include "simulator/loading/run_case.h"
#include "simulator/scene/read_scene.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/operator_build.h"

namespace faultsim {

using nlohmann::json;

struct Simulation::Impl {
  std::optional<JsonDocument> held;  ///< none: the scene at hand is the one held.
  LoadedScene at_hand;
  std::string key;  ///< of the operator that the scene at hand needs.
  CachePolicy cache;
  PreparedOperator prepared;
  std::string prepared_key;
  std::unique_ptr<OperatorBuild> build;        ///< also one that was called off and has not ended.
  std::map<std::string, std::string> aliases;  ///< of `held`.

  void take(LoadedScene loaded) {
    at_hand = std::move(loaded);
    key = operator_key(at_hand);
  }
  bool change_quickly(const Changes& changes);
};

/// Without the lines of the file, which only messages need. @returns whether all is well; if not,
/// nothing has changed.
bool Simulation::Impl::change_quickly(const Changes& changes) {
  JsonDocument document{held->source, held->value, {}};
  try {
    for (const Change& change : changes) {
      const auto found = aliases.find(change.parameter);
      const bool is_alias = found != aliases.end();
      if (!is_alias && !change.parameter.starts_with('/')) return false;
      const std::string& pointer = is_alias ? found->second : change.parameter;
      json value = value_of_text(change.value, document.source, pointer);
      if (pointer.size() < 2 || !put_value(document.value, pointer, std::move(value))) return false;
    }
    take(load_scene(std::move(document)));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

Simulation::Simulation() : impl_(std::make_unique<Impl>()) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation Simulation::from_file(const std::string& file, const Changes& changes) {
  Simulation simulation;
  simulation.hold(read_scene_file(file, changes));
  LoadedScene& loaded = simulation.impl_->at_hand;
  loaded.plan.warnings = pressure_warnings(loaded.scene);
  return simulation;
}

Simulation Simulation::from_text(std::string_view text, const std::string& source) {
  Simulation simulation;
  simulation.hold(parse_json(text, source));
  return simulation;
}

void Simulation::keep_operators(const CachePolicy& policy) { impl_->cache = policy; }

void Simulation::hold(JsonDocument document) {
  impl_->take(load_scene(std::move(document)));
  impl_->held.reset();
}

void Simulation::change(const Changes& changes) {
  Impl& self = *impl_;
  if (!self.held) {
    self.held = self.at_hand.document;
    self.aliases = parameter_aliases(*self.held);
  }
  if (self.change_quickly(changes)) return;
  JsonDocument document = *self.held;
  apply(changes, document);
  self.take(load_scene(std::move(document)));
}

const LoadedScene& Simulation::scene() const { return impl_->at_hand; }

std::string Simulation::plan_text() const { return plan_to_text(impl_->at_hand.plan); }

std::string Simulation::identity() const { return case_identity(impl_->at_hand.scene); }

bool Simulation::needs_operator() const {
  return !impl_->prepared.op || impl_->prepared_key != impl_->key;
}

bool Simulation::prepare(const RunContext& context, bool keep_bulk) {
  Impl& self = *impl_;
  const bool has_bulk = self.prepared.bulk != nullptr || self.at_hand.plan.creep.active;
  if (!needs_operator() && (has_bulk || !keep_bulk)) return false;
  self.prepared = {};  // frees the old operator before the new one is built
  if (self.build) self.build->wait_for_end(context);  // two would need the memory of both
  context.stop.throw_if_requested("preparing the operator");
  self.build = std::make_unique<OperatorBuild>(self.at_hand.scene, self.at_hand.plan, self.cache,
                                               keep_bulk, context.n_threads);
  self.prepared = self.build->wait(context);
  self.build.reset();
  self.prepared_key = self.key;
  if (!self.prepared.remark.empty()) context.note(self.prepared.remark);
  return true;
}

const PreparedOperator& Simulation::prepared() const {
  FAULTSIM_DEMAND(!needs_operator(), "no operator for the scene at hand");
  return impl_->prepared;
}

CaseResult Simulation::run(const RunContext& context, const RunWatch& watch) {
  prepare(context);
  CaseProbe probe;
  probe.tried = watch.tried;
  return run_case(impl_->at_hand.scene, impl_->prepared, context, watch.step, probe);
}

CaseResult Simulation::run(const Changes& changes, const RunContext& context,
                           const RunWatch& watch) {
  change(changes);
  return run(context, watch);
}

}  // namespace faultsim
