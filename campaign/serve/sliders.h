#pragma once

#include <string>
#include <utility>
#include <vector>

#include "campaign/common/json.h"
#include "campaign/serve/request.h"
#include "campaign/store/store.h"

/// Inside of the room: what of a case a page lets its reader change.
namespace faultsweep::serve {

/// A parameter with a slider, or with a few values to choose from.
struct Slider {
  std::string name;                   ///< "friction angle"
  std::vector<std::string> pointers;  ///< into the scene: all get the value.
  std::string unit;                   ///< of the numbers; "" = a plain number.
  double value = 0, from = 0, to = 0;
  bool is_log = false;
  /// Instead of numbers: the name of each choice and its changes of the scene.
  std::vector<std::pair<std::string, ordered_json>> choices = {};
  bool of_campaign = false;    ///< varied there; from and to are those of its design.
  bool keeps_operator = true;  ///< else a change takes an operator of its own, built first.
  std::string meaning = {};    ///< one sentence; may be empty.
};

/// Parameters of the campaign in the order of its spec; then those others of the scene that have a
/// short name and keep the operator, in the order of the scene, from half to twice their value or
/// so.
/// @param scene  the case's document.
std::vector<Slider> sliders_of(const json& scene, const std::string& resolved_spec);

/// Throws HttpError where a change is none that these let a reader make: of another place, of words
/// that are no choice. A scene may name files; no request may.
void require_allowed(const std::vector<Slider>& sliders, const json& changes);

/// {"parameters": [{"name", "pointers", "unit", "value", "from", "to", "log", ...}]}
ordered_json to_json(const std::vector<Slider>& sliders);

}  // namespace faultsweep::serve
