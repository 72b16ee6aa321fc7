#include "simulator/reading/field_ends.h"

#include <cmath>

#include "simulator/common/text.h"
#include "simulator/scene/field_extents.h"

namespace faultsim {

void read_field_ends(SceneReader& reader, const std::string& at, const std::string& whose,
                     double length, std::optional<double>& y_from, std::optional<double>& y_to) {
  const double half = 0.5 * length;
  if (reader.has(at + "length")) {
    if (y_from || y_to) {
      reader.problem(at + "length",
                     concat("is given alongside ", y_from ? "y_from" : "y_to",
                            ", but fixes both ends: it is centred on y = 0"),
                     "remove one of the two");
      return;
    }
    const double own = reader.real(at + "length");
    y_from = -0.5 * own;
    y_to = 0.5 * own;
  }
  const double from = y_from.value_or(-half), to = y_to.value_or(half);
  if (to - from < kLeastExtent) {
    const char* key = y_to ? "y_to" : "y_from";
    reader.problem(at + key,
                   whose + " reaches from y = " + metres(from) + " to " + metres(to) +
                       ", which leaves no length",
                   y_from && y_to ? std::string("write y_to larger than y_from")
                                  : concat("add ", y_to ? "y_from" : "y_to",
                                           ": without it that end is at half the common length"));
  }
  if (y_from == -half) y_from.reset();
  if (y_to == half) y_to.reset();
}

void check_field_ends(SceneReader& reader, const std::string& at, const FieldGeometry& field) {
  const double half = 0.5 * field.length;
  for (const std::string key : kEndKeys) {
    if (!reader.has(at + key)) continue;
    const bool is_length = key == "length";
    const double value = reader.real(at + key);
    if (!(std::abs(value) > (is_length ? field.length : half))) continue;
    reader.problem(
        at + key,
        reader.as_given(at + key) +
            (is_length ? " is more than the model's length, " + reader.as_given("/geometry/length")
                       : " is not inside the model, y = " + metres(-half) + " to " + metres(half)),
        is_length ? "make it shorter or the model longer" : "make /geometry/length larger");
  }
}

}  // namespace faultsim
