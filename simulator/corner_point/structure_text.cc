#include "simulator/corner_point/structure_text.h"

#include <numbers>

#include "simulator/common/text.h"

namespace faultsim::corner_point {
namespace {

const char* word_of(RemarkKind kind) {
  switch (kind) {
    case RemarkKind::recognised:
      return "";
    case RemarkKind::left_out:
      return "left out: ";
    case RemarkKind::choice:
      return "chosen: ";
    case RemarkKind::warning:
      return "warning: ";
  }
  return "";
}

const char* word_of(EndKind kind) {
  switch (kind) {
    case EndKind::tip:
      return "tip";
    case EndKind::grid_edge:
      return "edge";
    case EndKind::junction:
      return "fault";
    case EndKind::closed:
      return "closed";
  }
  return "";
}

}  // namespace

std::string remarks_text(const std::vector<StructureRemark>& remarks) {
  std::string text;
  for (const StructureRemark& remark : remarks) {
    text += word_of(remark.kind) + remark.text;
    text += remark.option.empty() ? "\n" : " [" + remark.option + "]\n";
  }
  return text;
}

std::string structure_text(const GridStructure& structure) {
  std::string text = remarks_text(structure.report);
  constexpr double kDegree = std::numbers::pi / 180;
  if (!structure.faults.empty())
    text += "\nfault  edges  length m  offset m  dip deg  towards deg  ends\n";
  for (std::size_t f = 0; f < structure.faults.size(); ++f) {
    const Fault& fault = structure.faults[f];
    text += formatted("%5d  %5d  %8.0f  %8.1f  %7.0f  %11.0f  %s, %s\n", static_cast<int>(f) + 1,
                      static_cast<int>(fault.edges.size()), fault.length, fault.largest_offset,
                      fault.dip.median / kDegree, fault.dip_direction / kDegree,
                      word_of(fault.begin.kind), word_of(fault.end.kind));
  }
  text += "\ncompartment  cells  area km2  volume m3  mean top m  mean base m\n";
  for (const Compartment& compartment : structure.compartments) {
    text += formatted("%11d  %5d  %8.3f  %9.3g  %10.1f  %11.1f\n", compartment.region,
                      static_cast<int>(compartment.cells.size()), compartment.area / 1e6,
                      compartment.volume, compartment.mean_top, compartment.mean_base);
  }
  return text;
}

std::string traces_csv(const GridStructure& structure) {
  std::string text = "fault,x [m],y [m]\n";
  for (std::size_t f = 0; f < structure.faults.size(); ++f) {
    for (const Eigen::Vector2d& point : structure.faults[f].trace)
      text += concat(f + 1, ',', point.x(), ',', point.y(), '\n');
  }
  return text;
}

std::string offsets_csv(const GridStructure& structure) {
  std::string text = "fault,along [m],x [m],y [m],offset [m]\n";
  for (std::size_t f = 0; f < structure.faults.size(); ++f) {
    const Fault& fault = structure.faults[f];
    for (std::size_t p = 0; p < fault.pillars.size(); ++p)
      text += concat(f + 1, ',', fault.along[p], ',', fault.pillars[p].x(), ',',
                     fault.pillars[p].y(), ',', fault.offset[p], '\n');
  }
  return text;
}

}  // namespace faultsim::corner_point
