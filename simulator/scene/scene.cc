#include "simulator/scene/scene.h"

#include <algorithm>

#include "simulator/common/errors.h"

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

std::set<std::string> used_materials(const Scene& scene) {
  std::set<std::string> used;
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  for (const Layer& layer : is_field ? scene.field.layers : scene.box.layers) {
    used.insert(layer.material);
  }
  used.insert(is_field ? scene.field.sideburden : scene.box.material);
  return used;
}

bool has_viscous_material(const Scene& scene) {
  const std::set<std::string> used = used_materials(scene);
  return std::ranges::any_of(scene.materials, [&](const Material& material) {
    return material.viscosity && used.count(material.name) != 0;
  });
}

std::vector<std::string> region_names(const Scene& scene) {
  std::vector<std::string> names;
  if (scene.geometry_kind == GeometryKind::field) {
    for (const Block& block : scene.field.blocks) names.push_back(block.name);
  } else {
    for (const PressureRegion& region : scene.box.regions) names.push_back(region.name);
  }
  return names;
}

}  // namespace faultsim
