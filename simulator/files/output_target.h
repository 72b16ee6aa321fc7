#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/words.h"

/// What a command may write to, decided before it works. Nothing that a command reads, no store and
/// no file inside one, nothing but regular files, and no file of another kind is ever replaced;
/// folders above the one named are not made.
namespace faultsim {

/// What a file holds, as its first bytes tell.
enum class FileKind {
  text,      ///< none of the others.
  json,      ///< begins with { or [.
  hdf5,      ///< an HDF5 file.
  database,  ///< an SQLite database.
};
constexpr auto words(FileKind) {
  return std::array{"a text file", "a JSON file", "an HDF5 file", "an SQLite database"};
}

/// True for "-" and the names that the system has for standard output.
bool is_standard_output(const std::filesystem::path& target);

/// Throws InputError that names the option, all problems in it, unless target is a new name in a
/// folder that exists or a regular file of the same kind that may be replaced.
/// @param option  printed before the problem: "-o".
/// @param inputs  files that the command reads.
void require_writable_file(const std::string& option, const std::filesystem::path& target,
                           FileKind kind, const std::vector<std::filesystem::path>& inputs);

/// The same for a folder: it exists, or the one above it does. It is in no store.
void require_writable_folder(const std::string& option, const std::filesystem::path& folder);

/// Files that a document names: every text in it that is the path of a regular file, counted from
/// the folder of `file`; and `file` itself.
std::vector<std::filesystem::path> files_named_in(const nlohmann::json& document,
                                                  const std::filesystem::path& file);

/// The first of the files that lies at the path or below it; empty when none does. Links are
/// followed.
std::filesystem::path input_at_or_below(const std::filesystem::path& path,
                                        const std::vector<std::filesystem::path>& files);

}  // namespace faultsim
