#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/case_figures/case_figures.h"
#include "simulator/case_figures/section_pressures.h"
#include "simulator/figure/section.h"

namespace faultsim::case_figures {

/// What is painted into the reservoirs of a case's section: by how much the pressures of its flow
/// result, or the temperatures of one that has those alone, have changed, with one scale for all
/// load steps, and for the case before a change; and what is said of it. Of a case without such a
/// result nothing is, nor where flow cells lie over each other in the section: then it is said.
class PaintedSection {
 public:
  /// @pre the picture is of a field, with faults and load steps.
  explicit PaintedSection(const CasePicture& picture);

  /// Paints the field's section (field_section) at a time, s.
  void paint(double time, figure::Section& section) const;

 private:
  std::optional<SectionPressures> pressures_;
  double unit_ = 1;  ///< Pa or K, of the colours' numbers.
  std::optional<figure::Section::Painted> painted_;
};

}  // namespace faultsim::case_figures
