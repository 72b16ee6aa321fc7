#include "simulator/gmsh/gmsh_mesh.h"

#include <string>

#include "simulator/common/fingerprint.h"
#include "simulator/common/input_file.h"
#include "simulator/gmsh/mesh_assembly.h"
#include "simulator/gmsh/read_content.h"

namespace faultsim {

GmshMesh read_gmsh(const std::filesystem::path& file) {
  const std::string source = file.string();
  const std::string text = read_input_or_throw(source, kMostGmshBytes);
  const FileForm form = read_file_form(text, source);
  FileProblems problems(source);
  if (form.is_binary) problems.set_binary();
  const GmshContent content = read_content(text, form, problems);
  GmshMesh mesh = assemble_mesh(content, problems);
  problems.require_none();
  mesh.fingerprint = fingerprint(text);
  return mesh;
}

}  // namespace faultsim
