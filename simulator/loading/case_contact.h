#pragma once

#include "simulator/contact/contact.h"
#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The scene's friction per node, with radiation damping where slip events are followed.
ContactLaws contact_laws(const Scene& scene, const FaultGeometry& geometry);

/// The scene's knobs of the contact solve.
ContactOptions contact_options(const Numerics& numerics);

}  // namespace faultsim
