#include "campaign/render/answer.h"

namespace faultsweep {

ShownUnit shown_unit(faultsim::Dimension dimension, bool per_metre) {
  using faultsim::Dimension;
  const std::string si = faultsim::si_unit(dimension);
  switch (dimension) {
    case Dimension::pressure:
      return {"bar", kBar, si};
    case Dimension::time:
      return {"a", kYear, si};
    case Dimension::area:
    case Dimension::moment:
    case Dimension::potency: {
      const std::string shown = dimension == Dimension::area      ? "m²"
                                : dimension == Dimension::potency ? "m³"
                                                                  : "N m";
      return per_metre ? ShownUnit{shown + "/m", 1, si + "/m"} : ShownUnit{shown, 1, si};
    }
    default:
      return {si, 1, si};
  }
}

AnswerTable& Answer::add(AnswerTable table) {
  return std::get<AnswerTable>(blocks.emplace_back(std::move(table)));
}

}  // namespace faultsweep
