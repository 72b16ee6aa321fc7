#include "simulator/app/export_study.h"

#include <cerrno>
#include <fstream>

#include "simulator/coupled/petsc_files.h"
#include "simulator/coupled/solver_study.h"
#include "simulator/files/atomic_file.h"

namespace faultsim {
namespace {

template <typename Write>
void write_file(const std::filesystem::path& path, const Write& write) {
  PendingFile file(path);
  std::ofstream to(file.temporary(), std::ios::binary);
  write(to);
  if (!to.flush()) file.fail(errno);
  file.commit();
}

}  // namespace

void export_study(const std::filesystem::path& folder, const TwoSidedBulk& bulk,
                  const SaddlePoint& j) {
  create_folders(folder);
  const double scale = scale_of_multipliers(j);
  write_file(folder / "leading.petsc", [&](std::ostream& to) {
    if (j.symmetric) {
      write_petsc_transposed(to, j.leading());
    } else {
      write_petsc(to, j.leading());
    }
  });
  write_file(folder / "coupling.petsc",
             [&](std::ostream& to) { write_petsc(to, scale * j.coupling); });
  write_file(folder / "constraint.petsc",
             [&](std::ostream& to) { write_petsc_transposed(to, scale * j.constraint); });
  write_file(folder / "near-null.petsc", [&](std::ostream& to) {
    const Eigen::MatrixXd motions = j.motions();
    for (int k = 0; k < motions.cols(); ++k) write_petsc(to, motions.col(k));
  });
  const auto write_load = [&](const char* name, const StudyLoad& load) {
    Eigen::VectorXd all(j.n_displacements() + j.n_multipliers());
    all << load.f, scale * load.g;
    write_file(folder / name, [&](std::ostream& to) { write_petsc(to, all); });
  };
  write_load("random.petsc", random_load(bulk, j));
  write_load("physical.petsc", physical_load(bulk, j));
}

}  // namespace faultsim
