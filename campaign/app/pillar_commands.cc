#include <unistd.h>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "campaign/app/commands.h"
#include "campaign/common/names.h"
#include "campaign/pillars/fault_map.h"
#include "campaign/pillars/map_frames.h"
#include "campaign/pillars/pillar_campaign.h"
#include "campaign/render/render.h"
#include "campaign/spec/pointers.h"
#include "simulator/common/printable.h"
#include "simulator/common/units.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/output_target.h"
#include "simulator/files/result_folder.h"

namespace faultsweep {
namespace {

struct PillarArguments {
  std::filesystem::path table, scene, folder;
  std::filesystem::path names;        ///< JSON: what the table calls the columns; "" = as we do.
  std::string name;                   ///< of the campaign; "" = that of the table's file.
  std::string stress_azimuth;         ///< "160 deg", of the largest horizontal stress; "" = none.
  std::vector<double> stress_ratios;  ///< largest, smallest.
};

ColumnNames names_in(const std::filesystem::path& file) {
  ColumnNames names;
  if (file.empty()) return names;
  const faultsim::JsonDocument document = faultsim::read_json_file(file.string());
  for (const auto& [name, header] : document.value.items()) {
    if (document.value.is_object() && header.is_string()) {
      names[name] = header.get<std::string>();
      continue;
    }
    throw InputError(file.string(),
                     {{"/" + name, document.line_of("/" + name), "is not the name of a column",
                       "write { \"depth\": \"TOP_TVD [m]\" }"}});
  }
  return names;
}

std::optional<RegionalStress> stress_of(const PillarArguments& arguments) {
  if (arguments.stress_azimuth.empty()) return std::nullopt;
  const auto azimuth = faultsim::parse_quantity(arguments.stress_azimuth, Dimension::angle);
  if (!azimuth.ok) throw InputError("--stress-azimuth", azimuth.what, azimuth.cure);
  if (arguments.stress_ratios.size() != 2 ||
      !(arguments.stress_ratios[0] >= arguments.stress_ratios[1]))
    throw InputError("--stress-ratios", "the azimuth needs two ratios, the larger first",
                     "write --stress-ratios 0.83 0.74");
  return RegionalStress{azimuth.value / faultsim::kDegree, arguments.stress_ratios[0],
                        arguments.stress_ratios[1]};
}

/// The name of the campaign: the file's, with dashes for what names of campaigns may not hold.
std::string name_of(const PillarArguments& arguments) {
  if (!arguments.name.empty()) return arguments.name;
  std::string name = arguments.table.stem().string();
  for (char& letter : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
    if (!is_plain) letter = '-';
  }
  return name;
}

std::string refused_csv(const PillarCampaign& campaign) {
  std::string text = "id,line,column,what,cure\n";
  for (const RefusedPillar& one : campaign.refused) {
    for (const faultsim::Problem& problem : one.problems) {
      text += csv_name(one.id) + "," + std::to_string(one.line) + "," + csv_name(problem.pointer) +
              "," + csv_name(problem.what) + "," + csv_name(problem.cure) + "\n";
    }
  }
  return text;
}

/// Line by line what is wrong, as far as a screen goes.
std::string refused_text(const PillarCampaign& campaign) {
  constexpr std::size_t kShown = 40;
  std::string text;
  std::size_t n = 0;
  for (const RefusedPillar& one : campaign.refused) {
    for (const faultsim::Problem& problem : one.problems) {
      if (n++ >= kShown) continue;
      text +=
          concat("  line ", one.line, ", pillar ", faultsim::printable(one.id),
                 problem.pointer.empty() ? "" : ", column ", faultsim::printable(problem.pointer),
                 ": ", problem.what, "; ", problem.cure, "\n");
    }
  }
  if (n > kShown) text += concat("  ", n - kShown, " more are in refused.csv\n");
  return text;
}

ExitCode pillars(const StoreArguments&, const PillarArguments& arguments) {
  const PillarTable table = read_pillar_table(arguments.table, names_in(arguments.names));
  const auto base = faultsim::read_json_file(arguments.scene.string());
  std::vector<std::filesystem::path> inputs = {arguments.table, arguments.scene};
  if (!arguments.names.empty()) inputs.push_back(arguments.names);
  faultsim::ResultFolder folder(
      {.option = "-o",
       .folder = arguments.folder,
       .made_by = "faultsweep pillars",
       .names = {"campaign.json", "samples.csv", "places.csv", "refused.csv"},
       .inputs = inputs});
  const std::filesystem::path scene = std::filesystem::proximate(arguments.scene, arguments.folder);
  const bool shows = isatty(STDERR_FILENO) != 0;
  const PillarCampaign campaign = make_pillar_campaign(
      table, base, scene.string(), name_of(arguments), stress_of(arguments), [&](std::size_t i) {
        if (shows && i % 100 == 0)
          std::fprintf(stderr, "\r%zu of %zu pillars checked", i, table.n_pillars());
      });
  if (shows) std::fputs("\r\033[K", stderr);
  const std::size_t n_pillars = table.n_pillars() + table.refused.size();
  std::string text = concat(counted(n_pillars, "pillar", "pillars"), ": ",
                            counted(campaign.n_cases, "section", "sections"), ", ",
                            campaign.refused.size(), " refused\n", refused_text(campaign));
  for (const std::string& one : table.ignored) text += "  column \"" + one + "\" is not used\n";
  if (campaign.largest_shear_left_out > 0)
    text += concat("  shear on the section is neglected: up to ",
                   shortest_text(std::round(1000 * campaign.largest_shear_left_out) / 1000),
                   " of the vertical effective stress\n");
  print_text(text);
  if (campaign.n_cases == 0)
    throw InputError(arguments.table.string(),
                     {{"", 0, "no pillar can be modelled", "see the reasons for each"}});
  faultsim::write_text(folder.path() / "campaign.json", campaign.spec);
  faultsim::write_text(folder.path() / "samples.csv", campaign.samples);
  faultsim::write_text(folder.path() / "places.csv", campaign.places);
  faultsim::write_text(folder.path() / "refused.csv", refused_csv(campaign));
  folder.commit();
  say("Next: faultsweep submit ", (arguments.folder / "campaign.json").string());
  return ExitCode::done;
}

struct MapArguments {
  std::filesystem::path places, output;
};

/// A file for each year beside the collection: "map.pvd", "map_0000.vtu", "map_0001.vtu", ...
void write_frames(const Store& store, FaultMap map, const std::filesystem::path& collection) {
  const std::vector<MapFrame> frames = make_map_frames(store, map);
  if (frames.empty())
    throw InputError("-o", {{"", 0, "no pillar has a history", "run the campaign first"}});
  std::vector<FrameFile> files;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    char number[32];
    std::snprintf(number, sizeof number, "_%04zu.vtu", k);
    files.push_back({frames[k].year, collection.stem().string() + number});
    map.properties = frames[k].properties;
    faultsim::write_text(collection.parent_path() / files.back().name, fault_map_to_vtu(map));
  }
  faultsim::write_text(collection, frames_to_pvd(files));
}

ExitCode map(const StoreArguments& common, const MapArguments& arguments) {
  const std::string kind = arguments.output.extension().string();
  if (kind != ".csv" && kind != ".vtu" && kind != ".ts" && kind != ".pvd")
    throw InputError("-o", concat("\"", kind, "\" is not a kind of map"),
                     "name a file ending in .csv, .vtu, .pvd or .ts");
  faultsim::require_writable_file("-o", arguments.output, faultsim::FileKind::text,
                                  {arguments.places});
  const Store store = Store::open_reader(common.store);
  const FaultMap map = make_fault_map(store, store.campaign(common.campaign), arguments.places);
  if (kind == ".pvd") {
    write_frames(store, map, arguments.output);
    return ExitCode::done;
  }
  const std::string text = kind == ".csv"   ? fault_map_to_csv(map)
                           : kind == ".vtu" ? fault_map_to_vtu(map)
                                            : fault_map_to_tsurf(map);
  if (text.empty())
    throw InputError("-o", {{"", 0, "no fault has two pillars: there is no surface between them",
                             "add a column \"fault\" to the table, or write .vtu"}});
  faultsim::write_text(arguments.output, text);
  return ExitCode::done;
}

}  // namespace

void add_pillars(Program& program) {
  auto [command, a] =
      program.add("pillars", "a campaign from a table of fault pillars of your own field", pillars);
  command->add_option("table", a.table, "CSV, a line for each pillar")->required();
  command
      ->add_option("--scene", a.scene,
                   "a field of two blocks: west is the footwall, east the hanging wall")
      ->required();
  command->add_option("-o,--output", a.folder, "folder for campaign.json and its tables")
      ->required();
  command->add_option("--names", a.names,
                      "JSON: the table's names of the columns, {\"depth\": \"TOP_TVD [m]\"}");
  command->add_option("--name", a.name, "of the campaign (default: that of the table's file)");
  CLI::Option* azimuth = command->add_option("--stress-azimuth", a.stress_azimuth,
                                             "\"160 deg\": of the largest horizontal stress");
  command
      ->add_option("--stress-ratios", a.stress_ratios,
                   "largest and smallest effective horizontal stress over the vertical one")
      ->expected(2)
      ->needs(azimuth);
  command->footer(
      "Columns: id, fault, x [m], y [m], azimuth [deg], depth [m], offset [m], thickness [m] or\n"
      "thickness_foot [m] and thickness_hanging [m], dip [deg] (from the vertical) or\n"
      "dip_from_horizontal [deg], until (the date at which a pillar's history ends), and any\n"
      "parameter that `faultsim parameters` lists. An incomplete line is refused without\n"
      "affecting others; refused.csv lists those, with line, column and cure.\n"
      "A pressure_field or temperature_field of the scene is read at the place of each pillar.\n"
      "The pressure of first sliding is searched for within its load step, to 0.1 bar or to the\n"
      "scene's /numerics/activation_tolerance.\n"
      "Examples:\n"
      "  faultsweep pillars pillars.csv --scene section.json -o pillars\n"
      "  faultsweep submit pillars/campaign.json && faultsweep run pillars\n"
      "  faultsweep map pillars/places.csv pillars -o map.vtu      for ParaView\n"
      "  faultsweep map pillars/places.csv pillars -o map.pvd      the same, year by year");

  auto [map_command, m] = program.add("map", "results at the pillars, on a map", map);
  map_command->add_option("places", m.places, "places.csv of `faultsweep pillars`")->required();
  add_campaign(map_command, program.common);
  map_command
      ->add_option("-o,--output", m.output,
                   "file: .csv, .vtu, .pvd (the same, year by year) or .ts (GOCAD surfaces)")
      ->required();
  map_command->footer("Example: faultsweep map pillars/places.csv pillars -o map.csv");
}

}  // namespace faultsweep
