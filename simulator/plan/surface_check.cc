#include <cmath>
#include <optional>
#include <utility>

#include "simulator/common/text.h"
#include "simulator/common/units.h"
#include "simulator/plan/geometry_check.h"

namespace faultsim {
namespace {

using Kind = SurfaceParameter::Kind;

constexpr long kMostCells = 10 * kMostCellsChecked;  // of all meshes that are made
constexpr std::size_t kMostAtCorners = 4;            // parameters, 16 corners

/// A parameter at one end of its range.
struct End {
  std::size_t of = 0;  ///< into SurfaceRequest::over.
  bool upper = false;
};

class SurfaceCheck {
 public:
  SurfaceCheck(const Scene& scene, const Plan& plan)
      : request_(scene.numerics.surface), exact_(scene), own_(mesh_of(scene, plan)) {
    exact_.numerics.surface = {};
  }

  std::vector<Problem> all() {
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < request_.over.size(); ++i) {
      const Kind kind = request_.over[i].kind;
      if (kind == Kind::dip || kind == Kind::offset) moving.push_back(i);
    }
    for (const std::size_t i : moving) {
      look({{i, false}});
      look({{i, true}});
    }
    if (!problems_.empty() || moving.size() < 2 || moving.size() > kMostAtCorners)
      return std::move(problems_);
    for (unsigned corner = 0; corner < 1u << moving.size() && problems_.empty(); ++corner) {
      std::vector<End> ends;
      for (std::size_t k = 0; k < moving.size(); ++k)
        ends.push_back({moving[k], (corner >> k & 1u) != 0});
      look(ends);
    }
    return std::move(problems_);
  }

 private:
  /// None where that would be too many cells.
  std::optional<Mesh> mesh_of(const Scene& scene, const Plan& plan) {
    n_cells_ += plan.n_cells;
    if (plan.n_cells > kMostCellsChecked || n_cells_ > kMostCells) return std::nullopt;
    return make_mesh(field_mesh_spec(scene, plan));
  }

  double value(const End& end) const {
    return end.upper ? request_.over[end.of].to : request_.over[end.of].from;
  }

  void look(const std::vector<End>& ends) {
    Scene scene = exact_;
    for (const End& end : ends) set_value(request_.over[end.of], value(end), scene);
    std::vector<Problem> found;
    const Plan plan = make_plan(scene, found);
    if (!found.empty()) return refuse(ends, "no mesh can be made: " + text_of(found.front()));
    try {
      const std::optional<Mesh> mesh = mesh_of(scene, plan);
      if (mesh && own_) compare(ends, *mesh);
    } catch (const InputError& error) {
      refuse(ends, "no mesh can be made: " + text_of(error.problems().front()));
    }
  }

  void compare(const std::vector<End>& ends, const Mesh& mesh) {
    if (mesh.nodes.size() != own_->nodes.size() || mesh.cells != own_->cells ||
        mesh.material != own_->material || mesh.region != own_->region ||
        mesh.tied_to != own_->tied_to) {
      refuse(ends, "the mesh has other cells than the scene's");
    }
  }

  static std::string text_of(const Problem& problem) {
    return problem.pointer + ": " + problem.what;
  }

  void refuse(const std::vector<End>& ends, const std::string& what) {
    std::string at;
    for (const End& end : ends) {
      const SurfaceParameter& one = request_.over[end.of];
      const bool is_dip = one.kind == Kind::dip;
      const Dimension dimension = is_dip ? Dimension::angle : Dimension::length;
      const auto i = static_cast<std::size_t>(one.index);
      at += concat(at.empty() ? "" : " and ",
                   is_dip ? "a dip of fault " + exact_.faults[i].name
                          : "an offset of block " + exact_.field.blocks[i].name,
                   " of ", number_text(from_si(value(end), dimension, is_dip ? "deg" : "m")),
                   is_dip ? " deg" : " m");
    }
    const std::string list = "/numerics/surface/over";
    const std::string pointer =
        ends.size() > 1 ? list : concat(list, "/", ends[0].of, ends[0].upper ? "/to" : "/from");
    problems_.push_back({pointer, 0, "with " + at + " " + what,
                         "narrow the range, move what is in the way, or use exact operators"});
  }

  static std::string number_text(double value) { return formatted("%.6g", value); }

  const SurfaceRequest& request_;
  Scene exact_;
  long n_cells_ = 0;
  std::optional<Mesh> own_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> surface_problems(const Scene& scene, const Plan& plan) {
  if (scene.geometry_kind != GeometryKind::field) return {};  // moduli move no mesh
  try {
    return SurfaceCheck(scene, plan).all();
  } catch (const InputError&) {  // of the scene's own mesh, which geometry_problems() says
    return {};
  }
}

}  // namespace faultsim
