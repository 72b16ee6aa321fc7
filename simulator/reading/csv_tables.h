#pragma once

#include <string>
#include <vector>

#include "simulator/documents/json_document.h"

/// A scene names CSV files and surfaces of faults; where it travels (a campaign's store, a result
/// folder) their text goes with it in "tables": {"file name": [lines]}, and the files are looked at
/// no more.
namespace faultsim {

/// The names of the CSV files that a scene uses, each once: of /pressure_csv, /compartments/*/csv,
/// the csv of fault pressures and that of tops of layers, and surfaces of faults.
std::vector<std::string> table_names(const nlohmann::json& scene);

/// Puts the lines of a CSV file into the scene's "tables", unless it is there. A file that cannot
/// be read is left to read_scene, which says so.
/// @param source  relative names are taken from the folder of this file (JsonDocument::source).
void embed_table(nlohmann::json& scene, const std::string& source, const std::string& name);
/// The same for all that the scene uses, and the places of its fields.
void embed_tables(JsonDocument& document);

/// The text of a table: from the scene's "tables", else from its file.
/// @throws InputError where it cannot be read.
std::string table_text(const nlohmann::json& scene, const std::string& source,
                       const std::string& name);

/// Where the file of a field is, and what was in it when the scene set out on its way.
struct FieldPlace {
  std::string path;
  std::string fingerprint;  ///< "" = nothing is known of it.
};
/// From the scene's "fields", else its own path. Fields are too large to travel with a scene.
FieldPlace field_place(const nlohmann::json& scene, const std::string& source,
                       const std::string& name);

/// Puts the places and the fingerprints of the fields that `named` names into the "fields" of a
/// scene, unless they are there. A file that cannot be read is left to read_scene, which says so.
/// @param named  a scene, or one as it will be.
void embed_fields(nlohmann::json& scene, const std::string& source, const nlohmann::json& named);

}  // namespace faultsim
