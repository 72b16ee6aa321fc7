#pragma once

#include <vector>

#include "simulator/figure/depth_chart.h"
#include "simulator/figure/section.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/scene.h"

/// Inside of the module: where things lie in a field.
namespace faultsim {

/// The compartments beside a fault of a field; none of a box.
std::vector<figure::DepthBand> compartments_beside(const Scene& scene, std::size_t fault);
/// The field's rocks and faults, without χ. @pre the scene is a field.
figure::Section field_section(const Scene& scene);

}  // namespace faultsim
