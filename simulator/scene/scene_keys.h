#pragma once

#include <array>
#include <string_view>

#include "simulator/common/struct_of.h"
#include "simulator/scene/scene.h"

/// The one list of the keys of a scene: for_each_key(struct, visit) calls visit(SceneKey, member)
/// for each member that a document says. What reads documents (read_keys.h), the canonical text and
/// with it a case's identity (canonical.cc), and the family (plan/family.cc) are written from it.
/// Unit, range and default of a key are those of schemas/scene.schema.json.
namespace faultsim {

/// How a document and the canonical text say a member.
struct SceneKey {
  std::string_view name;  ///< in the document.
  /// In the canonical text; "" = the same.
  std::string_view in_text = {};
  /// Every document has it: one that lacks it is refused, and it reads as NaN.
  bool required = false;
  /// Not read by its name: the reader of its struct sees to it.
  bool by_hand = false;
  /// False where other keys make it say nothing. Then it is not read, nor part of the identity.
  bool counts = true;
  /// Whether the canonical text has it. A key that came later stands in it only where it differs
  /// from what reproduces the old behaviour, so that identities stored before stay valid.
  bool in_identity = true;
  /// Stands in the canonical text as its word, not its number.
  bool as_word = false;
  /// Part of the family: the linear bulk depends on it.
  bool in_family = false;
};

// Words of enumerations, in their order.
constexpr auto words(Switch) { return std::array{"automatic", "on", "off"}; }
constexpr auto words(PatchShape) { return std::array{"rectangle", "ellipse"}; }
constexpr auto words(RegionShape) { return std::array{"box", "disc"}; }
constexpr auto words(BoundaryKind) {
  return std::array{"free", "roller", "fixed", "displacement", "stress", "tied"};
}
constexpr auto words(Side) { return std::array{"x-", "x+", "y-", "y+", "z-", "z+"}; }
constexpr auto words(InitialStressKind) { return std::array{"column", "profile"}; }
constexpr auto words(ViscousLayers) { return std::array{"ratios", "lithostatic"}; }
constexpr auto words(FrictionLaw) { return std::array{"angle", "coefficient"}; }
constexpr auto words(SlipMeasure) { return std::array{"current", "cumulated"}; }
constexpr auto words(FaultPressureRule) {
  return std::array{"mean",     "min",        "max",  "minus", "plus",
                    "fraction", "prescribed", "none", "table"};
}
constexpr auto words(TurningPoints) { return std::array{"steps", "report"}; }
constexpr auto words(CreepScheme) { return std::array{"exponential", "backward_euler"}; }
constexpr auto words(OutsideRule) { return std::array{"nearest", "unchanged"}; }

/// Its name is the key of the object.
template <Of<Material> Struct, typename Visit>
void for_each_key(Struct& m, Visit&& visit) {
  visit(SceneKey{"density"}, m.density);
  visit(SceneKey{.name = "youngs_modulus", .required = true, .in_family = true}, m.youngs_modulus);
  visit(SceneKey{.name = "poisson_ratio", .required = true, .in_family = true}, m.poisson_ratio);
  visit(SceneKey{"biot"}, m.biot);
  visit(SceneKey{.name = "thermal_expansion", .in_identity = m.thermal_expansion != 0},
        m.thermal_expansion);
  visit(SceneKey{"viscosity"}, m.viscosity);
}

template <Of<Layer> Struct, typename Visit>
void for_each_key(Struct& l, Visit&& visit) {
  visit(SceneKey{"name"}, l.name);
  visit(SceneKey{"material"}, l.material);
  visit(SceneKey{.name = "top", .required = true}, l.top_depth);
}

template <Of<Block> Struct, typename Visit>
void for_each_key(Struct& b, Visit&& visit) {
  visit(SceneKey{"name"}, b.name);
  visit(SceneKey{.name = "from", .required = true, .in_family = true}, b.from);
  visit(SceneKey{.name = "to", .required = true, .in_family = true}, b.to);
  visit(SceneKey{.name = "offset", .in_family = true}, b.offset);
  visit(SceneKey{"overpressure"}, b.overpressure);
  visit(SceneKey{.name = "mesh_offset", .in_family = true}, b.mesh_offset);
  visit(SceneKey{"thickness"}, b.thickness);
}

template <Of<FieldGeometry> Struct, typename Visit>
void for_each_key(Struct& f, Visit&& visit) {
  visit(SceneKey{.name = "kind", .by_hand = true}, "field");
  visit(SceneKey{.name = "width", .required = true}, f.width);
  visit(SceneKey{.name = "length", .required = true}, f.length);
  visit(SceneKey{.name = "depth", .required = true}, f.depth);
  visit(SceneKey{.name = "layers", .by_hand = true}, f.layers);
  visit(SceneKey{"reservoir_layer"}, f.reservoir_layer);
  visit(SceneKey{"sideburden"}, f.sideburden);
  visit(SceneKey{.name = "blocks", .by_hand = true}, f.blocks);
  visit(SceneKey{.name = "block_length", .required = true}, f.block_length);
  visit(SceneKey{.name = "fault_length", .required = true}, f.fault_length);
  visit(SceneKey{"fault_overshoot"}, f.fault_overshoot);
  visit(SceneKey{.name = "pivot_depth", .by_hand = true}, f.pivot_depth);
}

template <Of<PatchGeometry> Struct, typename Visit>
void for_each_key(Struct& p, Visit&& visit) {
  visit(SceneKey{.name = "center", .required = true, .in_family = true}, p.center);
  visit(SceneKey{.name = "strike", .in_family = true}, p.strike);
  visit(SceneKey{.name = "dip_from_vertical", .in_family = true}, p.dip_from_vertical);
  visit(SceneKey{.name = "length", .required = true, .in_family = true}, p.length);
  visit(SceneKey{.name = "width", .required = true, .in_family = true}, p.width);
  visit(SceneKey{.name = "shape", .in_family = true}, p.shape);
}

template <Of<TimeTable> Struct, typename Visit>
void for_each_key(Struct& t, Visit&& visit) {
  visit(SceneKey{.name = "time", .by_hand = true}, t.time);
  visit(SceneKey{.name = "factor", .by_hand = true}, t.factor);
}

template <Of<BoundaryCondition> Struct, typename Visit>
void for_each_key(Struct& c, Visit&& visit) {
  visit(SceneKey{.name = "sides", .by_hand = true, .in_family = true}, c.sides);
  visit(SceneKey{.name = "kind", .in_family = true}, c.kind);
  const bool moves = c.kind == BoundaryKind::displacement;
  const bool pulls = c.kind == BoundaryKind::stress;
  visit(SceneKey{.name = "components", .by_hand = true, .in_identity = moves, .in_family = true},
        c.components);
  visit(SceneKey{.name = "translation", .in_identity = moves, .in_family = true}, c.translation);
  visit(SceneKey{.name = "gradient", .in_identity = moves, .in_family = true}, c.gradient);
  visit(SceneKey{.name = "stress", .in_identity = pulls, .in_family = true}, c.stress);
  // It only scales the unit load.
  visit(SceneKey{.name = "table", .by_hand = true, .in_identity = moves || pulls}, c.table);
}

template <Of<PressureRegion> Struct, typename Visit>
void for_each_key(Struct& r, Visit&& visit) {
  visit(SceneKey{"name"}, r.name);
  visit(SceneKey{.name = "shape", .in_family = true}, r.shape);
  const bool is_disc = r.shape == RegionShape::disc;
  visit(SceneKey{.name = "from", .required = true, .counts = !is_disc, .in_family = true}, r.from);
  visit(SceneKey{.name = "to", .required = true, .counts = !is_disc, .in_family = true}, r.to);
  visit(SceneKey{.name = "center", .required = true, .counts = is_disc, .in_family = true},
        r.center);
  visit(SceneKey{.name = "radius", .required = true, .counts = is_disc, .in_family = true},
        r.radius);
  visit(SceneKey{.name = "thickness", .required = true, .counts = is_disc, .in_family = true},
        r.thickness);
}

template <Of<BoxGeometry> Struct, typename Visit>
void for_each_key(Struct& b, Visit&& visit) {
  visit(SceneKey{.name = "kind", .by_hand = true}, "box");
  visit(SceneKey{.name = "from", .required = true}, b.from);
  visit(SceneKey{.name = "to", .required = true}, b.to);
  visit(SceneKey{"material"}, b.material);
  visit(SceneKey{.name = "layers", .by_hand = true}, b.layers);
  visit(SceneKey{.name = "patches", .by_hand = true}, b.patches);
  visit(SceneKey{.name = "boundary", .by_hand = true}, b.boundary);
  visit(SceneKey{.name = "regions", .by_hand = true}, b.regions);
}

template <Of<MeshSizes> Struct, typename Visit>
void for_each_key(Struct& s, Visit&& visit) {
  visit(SceneKey{.name = "strike", .in_family = true}, s.strike);
  visit(SceneKey{.name = "dip", .in_family = true}, s.dip);
  visit(SceneKey{.name = "normal", .in_family = true}, s.normal);
  visit(SceneKey{.name = "growth", .in_family = true}, s.growth);
  visit(SceneKey{.name = "fine_margin", .in_family = true}, s.fine_margin);
  visit(SceneKey{.name = "largest", .in_family = true}, s.largest);
  // Cells of one size down dip keep the identity from before they could be graded.
  visit(SceneKey{.name = "corner", .in_identity = s.grades_corners()}, s.corner);
  visit(SceneKey{.name = "corner_growth", .in_identity = s.grades_corners()}, s.corner_growth);
}

template <Of<InitialState> Struct, typename Visit>
void for_each_key(Struct& s, Visit&& visit) {
  visit(SceneKey{.name = "kind", .as_word = true}, s.kind);
  const bool is_column = s.kind == InitialStressKind::column;
  const bool has_ratios = !s.tensor;
  visit(SceneKey{.name = "ratio_across", .in_identity = has_ratios}, s.ratio_across);
  visit(SceneKey{.name = "ratio_along", .in_identity = has_ratios}, s.ratio_along);
  visit(SceneKey{.name = "initial_biot", .in_identity = has_ratios}, s.initial_biot);
  visit(SceneKey{.name = "gravity", .in_identity = is_column}, s.gravity);
  visit(SceneKey{.name = "water_density", .in_identity = is_column}, s.water_density);
  visit(SceneKey{.name = "water_depth", .in_identity = is_column && s.water_depth != 0},
        s.water_depth);
  visit(SceneKey{.name = "overpressure", .in_identity = is_column}, s.overpressure);
  const bool is_linear = !is_column && has_ratios;
  visit(SceneKey{.name = "vertical_stress", .in_identity = is_linear}, s.vertical_stress);
  visit(SceneKey{.name = "vertical_stress_gradient", .in_identity = is_linear},
        s.vertical_stress_gradient);
  visit(SceneKey{.name = "pressure", .in_identity = !is_column}, s.pressure);
  visit(SceneKey{.name = "pressure_gradient", .in_identity = !is_column}, s.pressure_gradient);
  visit(SceneKey{.name = "tensor", .in_identity = !is_column}, s.tensor);
  visit(SceneKey{.name = "viscous_layers",
                 .in_identity = s.viscous_layers != ViscousLayers::ratios,
                 .as_word = true},
        s.viscous_layers);
}

/// A fault's own friction overrides the scene's key by key; angles may be given as coefficients.
template <Of<Friction> Struct, typename Visit>
void for_each_key(Struct& f, Visit&& visit) {
  visit(SceneKey{"law"}, f.law);
  visit(SceneKey{"cohesion"}, f.cohesion);
  visit(SceneKey{.name = "friction_angle", .in_text = "static", .by_hand = true},
        f.static_friction_angle);
  visit(SceneKey{.name = "dynamic_friction_angle", .in_text = "dynamic", .by_hand = true},
        f.dynamic_friction_angle);
  visit(SceneKey{.name = "slip_weakening_distance", .in_text = "distance", .by_hand = true},
        f.slip_weakening_distance);
  visit(SceneKey{"slip_measure"}, f.slip_measure);
  visit(SceneKey{"cohesion_after_opening"}, f.cohesion_after_opening);
  visit(SceneKey{"cohesion_after_slip"}, f.cohesion_after_slip);
}

/// A fault's own fault_pressure overrides the scene's key by key.
template <Of<FaultPressure> Struct, typename Visit>
void for_each_key(Struct& p, Visit&& visit) {
  visit(SceneKey{"rule"}, p.rule);
  visit(SceneKey{.name = "fraction", .counts = p.rule == FaultPressureRule::fraction}, p.fraction);
  const bool is_prescribed = p.rule == FaultPressureRule::prescribed;
  visit(SceneKey{.name = "prescribed", .required = true, .counts = is_prescribed}, p.prescribed);
  visit(SceneKey{.name = "table", .by_hand = true, .counts = is_prescribed}, p.table);
  visit(SceneKey{.name = "csv",
                 .in_text = "profile",
                 .by_hand = true,
                 .counts = p.rule == FaultPressureRule::table},
        p.profile);
  visit(SceneKey{.name = "depth_window", .counts = is_prescribed}, p.depth_window);
}

template <Of<Fault> Struct, typename Visit>
void for_each_key(Struct& f, Visit&& visit) {
  visit(SceneKey{"name"}, f.name);
  visit(SceneKey{"dip_from_vertical"}, f.dip_from_vertical);
  visit(SceneKey{.name = "fault_biot", .by_hand = true}, f.fault_biot);
  visit(SceneKey{.name = "friction", .by_hand = true}, f.friction);
  visit(SceneKey{.name = "fault_pressure", .in_text = "pressure", .by_hand = true}, f.pressure);
}

template <Of<Stage> Struct, typename Visit>
void for_each_key(Struct& s, Visit&& visit) {
  visit(SceneKey{"name"}, s.name);
  visit(SceneKey{.name = "duration", .by_hand = true}, s.duration);
  visit(SceneKey{"steps"}, s.n_steps);
  visit(SceneKey{.name = "stress_change", .in_identity = s.stress_change.has_value()},
        s.stress_change);
}

/// A compartment; its history is what the stages or a CSV file say.
template <Of<PressureHistory> Struct, typename Visit>
void for_each_key(Struct& h, Visit&& visit) {
  visit(SceneKey{.name = "region", .by_hand = true}, h.region);
  visit(SceneKey{.name = "time", .by_hand = true}, h.time);
  visit(SceneKey{.name = "pressure_change", .by_hand = true}, h.pressure_change);
  visit(SceneKey{"scale"}, h.scale);
  visit(SceneKey{"lag"}, h.lag);
}

/// Which file it was does not matter, what was in it does.
template <Of<FlowLoad> Struct, typename Visit>
void for_each_key(Struct& l, Visit&& visit) {
  visit(SceneKey{.name = "method", .by_hand = true}, kFieldMethod);
  visit(SceneKey{"outside"}, l.outside);
  visit(SceneKey{"origin"}, l.origin);
  visit(SceneKey{"azimuth"}, l.azimuth);
  visit(SceneKey{.name = "y", .by_hand = true}, l.y);
  visit(SceneKey{.name = "file", .in_text = "fingerprint", .by_hand = true}, l.fingerprint);
  visit(SceneKey{.name = "reference", .by_hand = true}, l.reference);
  visit(SceneKey{.name = "reports", .by_hand = true}, l.reports);
  visit(SceneKey{.name = "time", .by_hand = true}, l.time);
}

template <Of<ObservationPoint> Struct, typename Visit>
void for_each_key(Struct& p, Visit&& visit) {
  visit(SceneKey{"name"}, p.name);
  visit(SceneKey{.name = "position", .required = true}, p.position);
}

template <Of<OutputRequest> Struct, typename Visit>
void for_each_key(Struct& o, Visit&& visit) {
  visit(SceneKey{"fault_fields"}, o.fault_fields);
  visit(SceneKey{"volume_fields"}, o.volume_fields);
}

template <Of<SurfaceRequest> Struct, typename Visit>
void for_each_key(Struct& s, Visit&& visit) {
  visit(SceneKey{.name = "over", .by_hand = true}, s.over);
  visit(SceneKey{.name = "method", .by_hand = true}, kSurfaceMethod);
  visit(SceneKey{"tolerance"}, s.tolerance);
  visit(SceneKey{"most_operators"}, s.most_operators);
}

/// What creeps is told by the keys of for_each_creep_key besides.
template <Of<Numerics> Struct, typename Visit>
void for_each_key(Struct& n, Visit&& visit) {
  visit(SceneKey{"slip_tolerance"}, n.slip_tolerance);
  visit(SceneKey{"activation_length"}, n.activation_length);
  visit(SceneKey{"traction_tolerance"}, n.traction_tolerance);
  visit(SceneKey{"max_newton_iterations"}, n.max_newton_iterations);
  visit(SceneKey{"max_active_set_passes"}, n.max_active_set_passes);
  visit(SceneKey{"max_step_cuts"}, n.max_step_cuts);
  visit(SceneKey{"follow_events"}, n.follow_events);
  visit(SceneKey{"onset_tolerance"}, n.onset_tolerance);
  visit(SceneKey{"max_events"}, n.max_events);
  // The added steps follow from stages and histories, which are there.
  visit(SceneKey{.name = "turning_points",
                 .in_identity = n.turning_points == TurningPoints::report,
                 .as_word = true},
        n.turning_points);
  visit(SceneKey{.name = "max_added_steps", .in_identity = false}, n.max_added_steps);
  visit(SceneKey{"b_bar"}, n.b_bar);
  visit(SceneKey{"half_domain"}, n.half_domain);
  visit(SceneKey{"plane_strain"}, n.plane_strain);
}

template <Of<Numerics> Struct, typename Visit>
void for_each_creep_key(Struct& n, Visit&& visit) {
  visit(SceneKey{.name = "creep", .in_text = "switch"}, n.creep);
  visit(SceneKey{.name = "creep_time_step", .in_text = "time_step"}, n.creep_time_step);
  visit(SceneKey{.name = "creep_refinements", .in_text = "refinements"}, n.creep_refinements);
  visit(SceneKey{.name = "creep_tolerance", .in_text = "tolerance"}, n.creep_tolerance);
  visit(SceneKey{.name = "creep_scheme", .in_text = "scheme"}, n.creep_scheme);
}

}  // namespace faultsim
