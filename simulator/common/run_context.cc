#include "simulator/common/run_context.h"

#include "simulator/common/errors.h"

namespace faultsim {

void StopToken::throw_if_requested(const char* doing) const {
  if (requested()) throw Interrupted(concat("stopped while ", doing));
}

}  // namespace faultsim
