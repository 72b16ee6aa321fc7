#include "simulator/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/flow/flow_field.h"

namespace faultsim {
namespace {

using Kind = SurfaceParameter::Kind;

/// The member of the scene that a parameter is.
template <typename Any>
auto& member_of(const SurfaceParameter& one, Any& scene) {
  const auto i = static_cast<std::size_t>(one.index);
  switch (one.kind) {
    case Kind::youngs_modulus:
      return scene.materials.at(i).youngs_modulus;
    case Kind::poisson_ratio:
      return scene.materials.at(i).poisson_ratio;
    case Kind::dip:
      return scene.faults.at(i).dip_from_vertical;
    case Kind::offset:
      return scene.field.blocks.at(i).offset;
  }
  throw_internal("a kind of parameter", "", __FILE__, __LINE__);
}

}  // namespace

double value_of(const SurfaceParameter& one, const Scene& scene) { return member_of(one, scene); }

void set_value(const SurfaceParameter& one, double value, Scene& scene) {
  member_of(one, scene) = value;
}

std::string remark_text(const Remark& remark) {
  return remark.pointer.empty() ? remark.what : remark.pointer + " " + remark.what;
}

double thermal_stress(const Material& material) {
  return material.youngs_modulus / (1 - 2 * material.poisson_ratio) * material.thermal_expansion;
}

const Material& material_named(const Scene& scene, const std::string& name) {
  for (const Material& material : scene.materials) {
    if (material.name == name) return material;
  }
  throw_internal("the material exists", name, __FILE__, __LINE__);
}

bool have_same_body(const Scene& a, const Scene& b) {
  const auto is_same_surface = [](const Fault& one, const Fault& other) {
    return one.name == other.name && one.dip_from_vertical == other.dip_from_vertical;
  };
  return a.geometry_kind == b.geometry_kind && a.field == b.field && a.box == b.box &&
         a.materials == b.materials && a.mesh == b.mesh && a.numerics == b.numerics &&
         a.stages == b.stages && a.pressure == b.pressure && a.temperature == b.temperature &&
         a.pressure_field == b.pressure_field && a.temperature_field == b.temperature_field &&
         std::ranges::equal(a.faults, b.faults, is_same_surface);
}

Bounds bounds_of(const PressureRegion& region) {
  if (region.shape == RegionShape::box) return {region.from, region.to};
  const std::array<double, 3>& c = region.center;
  const double r = region.radius, half = 0.5 * region.thickness;
  return {{c[0] - r, c[1] - r, c[2] - half}, {c[0] + r, c[1] + r, c[2] + half}};
}

Bounds bounds_of(const PatchGeometry& patch) {
  const double a = 0.5 * patch.length, b = 0.5 * patch.width;
  const double lean = b * std::sin(patch.dip_from_vertical);
  const std::array<double, 3> half = {
      std::abs(a * std::sin(patch.strike)) + std::abs(lean * std::cos(patch.strike)),
      std::abs(a * std::cos(patch.strike)) + std::abs(lean * std::sin(patch.strike)),
      std::abs(b * std::cos(patch.dip_from_vertical))};
  Bounds bounds;
  for (std::size_t k = 0; k < 3; ++k) {
    bounds.low[k] = patch.center[k] - half[k];
    bounds.high[k] = patch.center[k] + half[k];
  }
  return bounds;
}

std::shared_ptr<const FlowField> field_in_scene(const FlowLoad& load) {
  if (load.origin == std::array<double, 2>{0, 0} && load.azimuth == 0) return load.field;
  return std::make_shared<const FlowField>(placed(*load.field, load.origin, load.azimuth));
}

const std::vector<Layer>& layers_of(const Scene& scene) {
  return scene.geometry_kind == GeometryKind::field ? scene.field.layers : scene.box.layers;
}

bool is_used(const Scene& scene, const Material& material) {
  if (is_meshed(scene))
    return contains(scene.box.mesh->volumes, material.name, &MeshVolume::material);
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  return material.name == (is_field ? scene.field.sideburden : scene.box.material) ||
         contains(layers_of(scene), material.name, &Layer::material);
}

std::vector<Material> used_materials(const Scene& scene) {
  std::vector<Material> used;
  std::ranges::copy_if(scene.materials, std::back_inserter(used),
                       [&](const Material& material) { return is_used(scene, material); });
  return used;
}

bool has_viscous_material(const Scene& scene) {
  return std::ranges::any_of(scene.materials, [&](const Material& material) {
    return material.viscosity && is_used(scene, material);
  });
}

std::vector<std::string> region_names(const Scene& scene) {
  return scene.geometry_kind == GeometryKind::field
             ? mapped(scene.field.blocks, &Block::name)
             : mapped(scene.box.regions, &PressureRegion::name);
}

}  // namespace faultsim
