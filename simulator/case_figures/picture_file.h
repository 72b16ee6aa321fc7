#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace faultsim {

/// Checks that a picture can be written to target before work begins: its name ends in .svg, .png
/// (or .html for pages) as `endings` say, and require_writable_file() holds. Throws InputError.
/// @param inputs  files that are read.
void require_picture_file(const std::filesystem::path& target,
                          const std::vector<std::string>& endings,
                          const std::vector<std::filesystem::path>& inputs);

/// Writes an SVG document, or the PNG that rsvg-convert makes of it at twice its size, as the name
/// says; complete or not at all. Throws InputError where a PNG is asked for and the program is not
/// installed, StorageError where it or the disk fails.
void write_picture(const std::filesystem::path& target, const std::string& svg);

}  // namespace faultsim
