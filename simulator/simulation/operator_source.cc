#include "simulator/simulation/operator_source.h"

#include <algorithm>

#include "simulator/operators/influence.h"
#include "simulator/reading/surface_probes.h"

namespace faultsim {
namespace {

SceneBulk bulk_of(const LoadedScene& loaded) { return {loaded.scene, loaded.plan, loaded.mesh}; }

ProbingScenes probes_of(const LoadedScene& loaded) {
  const SurfaceRequest& surface = loaded.scene.numerics.surface;
  if (!surface.probes) return {};
  return {static_cast<int>(surface_probes(loaded.document).size()),
          [document = loaded.document, over = surface.over](int i, const Scene& at) {
            return probing_scene(document, static_cast<std::size_t>(i), at, over);
          }};
}

/// Loads of flow results, and how much of them is assumed.
void take_loads(const FieldLoads& loads, PreparedOperator& prepared) {
  prepared.loads = {loads.history};
  prepared.field_coverage = loads.coverage;
  prepared.field_assumed = assumed_share(loads.integrals);
  prepared.integrals = loads.integrals;
}

/// What is to be said of the scene's flow results. Throws InputError where they do not fit.
FieldCheck checked_fields(const LoadedScene& loaded) {
  FieldCheck check = check_fields(loaded.scene, loaded.plan);
  if (!check.problems.empty()) throw InputError(loaded.document.source, check.problems);
  return check;
}

}  // namespace

std::string operator_case_key(const LoadedScene& loaded) {
  std::string key = operator_key(loaded);
  for (const SurfaceParameter& one : loaded.scene.numerics.surface.over)
    key += concat(" ", value_of(one, loaded.scene));
  if (loaded.scene.has_field()) key += " field " + field_loads_key(loaded.scene);
  return key;
}

const OperatorSource::KnownLoads* OperatorSource::Cells::find(const std::string& wanted) const {
  const auto known = std::ranges::find(loads, wanted, &KnownLoads::key);
  return known == loads.end() ? nullptr : &*known;
}

bool OperatorSource::has_cells(const LoadedScene& loaded, bool keep_bulk) const {
  return cells_.key == operator_key(loaded) && (cells_.prepared.bulk || !keep_bulk);
}

OperatorSource OperatorSource::for_another_thread() const {
  OperatorSource other = *this;
  if (cells_.prepared.bulk) other.cells_ = {};
  return other;
}

bool OperatorSource::is_at_hand(const LoadedScene& loaded, bool keep_bulk) const {
  const Scene& scene = loaded.scene;
  if (scene.numerics.surface.wanted()) {
    return !keep_bulk && surface_ && surface_key_ == operator_key(loaded) &&
           (!scene.has_field() || (fields_ && fields_key_ == canonical_parts(scene).fields));
  }
  return scene.has_field() && has_cells(loaded, keep_bulk) &&
         cells_.find(field_loads_key(scene)) != nullptr;
}

OperatorSource::Made OperatorSource::prepare(const LoadedScene& loaded, const CachePolicy& cache,
                                             bool keep_bulk, const RunContext& context) {
  const Scene& scene = loaded.scene;
  const bool on_surface = scene.numerics.surface.wanted();
  if (!on_surface) {
    fields_.reset();
    surface_.reset();
  }
  if (on_surface || !scene.has_field()) cells_ = {};
  if (on_surface) {
    Made made = from_surface(loaded, cache, context);
    if (keep_bulk) {  // of the exact bulk, moved by the loads and jumps of the case
      const Scene exact = without_surface(scene);
      // Its own plan: by the scene's it would be kept under the name of the surface.
      made.prepared.bulk = prepare_operator(exact, exact_plan(exact), cache, true, context).bulk;
    }
    if (scene.has_field()) add_fields(loaded, cache, context, made);
    return made;
  }
  if (scene.has_field()) return with_fields(loaded, cache, keep_bulk, context);
  return {prepare_operator(bulk_of(loaded), cache, keep_bulk, context), true};
}

/// The loads of a flow result are interpolated as the operator is.
void OperatorSource::add_fields(const LoadedScene& loaded, const CachePolicy& cache,
                                const RunContext& context, Made& made) {
  const std::string wanted = canonical_parts(loaded.scene).fields;
  const FieldCheck check = checked_fields(loaded);
  if (made.is_new || !fields_ || fields_key_ != wanted) {
    fields_.reset();
    fields_ = std::make_shared<const FieldSurface>(*surface_, loaded.scene, cache, context);
    fields_key_ = wanted;
    made.is_new = true;
  }
  const FieldLoads loads =
      fields_->at(loaded.scene, loaded.plan, *made.prepared.op, made.prepared.bulk.get());
  take_loads(loads, made.prepared);
  for (const Remark& one : check.remarks) made.prepared.warnings.push_back(remark_text(one));
  CaseSurface& errors = *made.prepared.surface;
  errors.traction = std::max(errors.traction, fields_->traction_error());
  errors.observation = std::max(errors.observation, fields_->observation_error());
}

OperatorSource::Made OperatorSource::from_surface(const LoadedScene& loaded,
                                                  const CachePolicy& cache,
                                                  const RunContext& context) {
  const std::string wanted = operator_key(loaded);
  const bool is_new = !surface_ || surface_key_ != wanted;
  if (is_new) {
    fields_.reset();
    surface_.reset();
    surface_ = std::make_shared<OperatorSurface>(loaded.scene, loaded.plan, probes_of(loaded),
                                                 cache, context);
    surface_key_ = wanted;
  }
  Made made{surface_->at(loaded.scene, loaded.plan), is_new};
  made.prepared.from_cache = surface_->from_cache();
  if (is_new) made.prepared.remark = surface_->remark();
  return made;
}

/// Where salt creeps, every length of a step has its own influence of cells: none is made, and the
/// factors are asked for the forces of all cells together.
OperatorSource::Cells OperatorSource::cells_of(const LoadedScene& loaded, const CachePolicy& cache,
                                               bool keep_bulk, const RunContext& context) {
  Cells cells;
  cells.key = operator_key(loaded);
  const SceneBulk bulk = bulk_of(loaded);
  cells.problem = bulk.problem();
  if (loaded.plan.creep.active) {
    cells.prepared = prepare_operator(bulk, cache, true, context);
    cells.block =
        std::make_shared<const InfluenceBlock>(cells_of_compartments(loaded.scene, *cells.problem));
    return cells;
  }
  PreparedInfluence made = prepare_influence(bulk, {}, cache, context, keep_bulk);
  cells.prepared.op = made.op;
  cells.prepared.bulk = made.bulk;
  cells.prepared.from_cache = made.from_cache;
  cells.prepared.remark = made.remark;
  cells.block = made.block;
  return cells;
}

/// The last loads are kept, as the realisations of an ensemble take turns.
OperatorSource::Made OperatorSource::with_fields(const LoadedScene& loaded,
                                                 const CachePolicy& cache, bool keep_bulk,
                                                 const RunContext& context) {
  constexpr std::size_t kMostKept = 16;
  const bool is_new = !has_cells(loaded, keep_bulk);
  const std::string wanted = field_loads_key(loaded.scene);
  const KnownLoads* known = is_new ? nullptr : cells_.find(wanted);
  FieldCheck check;
  if (known == nullptr) check = checked_fields(loaded);
  if (is_new) {
    cells_ = {};
    cells_ = cells_of(loaded, cache, keep_bulk, context);
  }
  if (known == nullptr) {
    context.progress(1, "mapping the flow result");
    const FieldCells cells{*cells_.prepared.op, cells_.problem->mesh, *cells_.block,
                           cells_.prepared.bulk.get()};
    KnownLoads made{wanted, field_loads(loaded.scene, cells, context.n_threads), {}};
    for (const Remark& one : check.remarks) made.warnings.push_back(remark_text(one));
    for (const std::string& text : made.loads.notes) context.note(text);
    cells_.loads.push_front(std::move(made));
    if (cells_.loads.size() > kMostKept) cells_.loads.pop_back();
    known = &cells_.loads.front();
  }
  Made made{cells_.prepared, is_new};
  if (!is_new) made.prepared.remark.clear();
  take_loads(known->loads, made.prepared);
  made.prepared.warnings = known->warnings;
  return made;
}

}  // namespace faultsim
