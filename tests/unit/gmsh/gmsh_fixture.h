#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "simulator/common/errors.h"
#include "simulator/gmsh/gmsh_mesh.h"
#include "tests/unit/gmsh/msh_writer.h"

namespace faultsim {

/// Bytes as a file "mesh.msh", as long as this lives.
class GmshFile {
 public:
  explicit GmshFile(const std::string& bytes) {
    std::string name = testing::TempDir() + "gmsh_XXXXXX";
    folder_ = mkdtemp(name.data());
    std::ofstream(path(), std::ios::binary) << bytes;
  }
  ~GmshFile() { std::filesystem::remove_all(folder_); }
  GmshFile(const GmshFile&) = delete;
  GmshFile& operator=(const GmshFile&) = delete;
  std::filesystem::path path() const { return folder_ / "mesh.msh"; }

 private:
  std::filesystem::path folder_;
};

inline GmshMesh read_bytes(const std::string& bytes) {
  const GmshFile file(bytes);
  return read_gmsh(file.path());
}

/// text with all `from` as `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// text with the one `from` in it as `to`.
inline std::string changed(const std::string& text, const std::string& from,
                           const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from << " stands twice";
  return text.substr(0, at) + to + text.substr(at + from.size());
}

/// What is said of a file of these bytes; "" = it is read.
inline std::string refusal(const std::string& bytes) {
  const GmshFile file(bytes);
  try {
    read_gmsh(file.path());
  } catch (const InputError& error) {
    return replaced(error.what(), file.path().string(), "mesh.msh");
  }
  return "";
}

/// The sound file that wrong ones are made of.
inline std::string sound_text() { return msh::text(msh::two_tetrahedra()); }
inline std::string sound_binary() {
  return msh::binary(msh::two_tetrahedra(), msh::ByteOrder::little);
}

// Cures that many messages end with.
inline const std::string kAnew =
    "; save the mesh with Gmsh and copy it again; the file is cut off, damaged or changed by hand";
inline const std::string kLine =
    "; write each on a line of its own, as Gmsh does, in decimal numbers with a point: 1.5, 1e5";

}  // namespace faultsim
