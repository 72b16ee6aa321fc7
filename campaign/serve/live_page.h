#pragma once

#include "campaign/serve/request.h"

namespace faultsweep::serve {

/// The page of a server: one script that asks it for parts and drawings and puts them in place.
/// Nothing is computed or drawn in the browser.
HttpResponse live_page();

}  // namespace faultsweep::serve
