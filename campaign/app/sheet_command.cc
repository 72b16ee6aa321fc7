#include "campaign/answers/fault_sheet.h"
#include "campaign/app/commands.h"
#include "campaign/common/names.h"
#include "campaign/figures/fault_sheet_page.h"
#include "campaign/figures/pdf_file.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/version.h"
#include "simulator/files/atomic_file.h"

namespace faultsweep {
namespace {

struct SheetArguments {
  SheetRequest request = {};
  std::string datum;             ///< "2100 m"; "" = of each fault.
  std::string levels;            ///< file; "" = those that are built in.
  std::filesystem::path output;  ///< .html; "" = none.
  std::filesystem::path pdf;     ///< "" = none.
};

SheetRequest request_of(const SheetArguments& arguments) {
  SheetRequest request = arguments.request;
  if (!arguments.datum.empty()) {
    const auto depth = faultsim::parse_quantity(arguments.datum, Dimension::length);
    if (!depth.ok) throw InputError("--datum", depth.what, depth.cure);
    request.datum = depth.value;
  }
  if (!arguments.levels.empty()) request.levels = read_levels(arguments.levels);
  request.program = faultsim::version_text("faultsweep");
  return request;
}

/// What the page was printed to; where there is no browser a page is enough, and the reason is
/// said.
void write_pdf(const SheetArguments& arguments, const std::string& html, std::size_t n_sheets) {
  const std::optional<std::string> pdf = pdf_of_page(html);
  if (!pdf) {
    const char* cure = "install chromium (Debian: chromium), or print the page from any browser";
    if (arguments.output.empty())
      throw InputError("--pdf", "no PDF was written: there is no Chromium to print it", cure);
    say("faultsweep: ", arguments.pdf.string(), " was not written: there is no Chromium to print ",
        arguments.output.string(), "; ", cure);
    return;
  }
  faultsim::write_text(arguments.pdf, *pdf);
  const std::size_t n_pages = count_pages(*pdf);
  if (n_pages != n_sheets) {
    say("faultsweep: ", arguments.pdf.string(), " has ", n_pages, " pages for ", n_sheets,
        " sheets: the table of levels or the names of stages are too long for one page");
  }
}

ExitCode sheet(const StoreArguments& common, const SheetArguments& arguments) {
  if (!arguments.output.empty())
    faultsim::require_picture_file(arguments.output, {".html"}, {arguments.levels});
  if (!arguments.pdf.empty())
    faultsim::require_picture_file(arguments.pdf, {".pdf"}, {arguments.levels});
  const SheetRequest request = request_of(arguments);
  const Store store = Store::open_reader(common.store);
  const std::vector<FaultSheet> sheets =
      find_fault_sheets(store, store.campaign(common.campaign), request);
  if (!arguments.output.empty() || !arguments.pdf.empty()) {
    const std::string html = sheet_page(sheets);
    if (!arguments.output.empty()) faultsim::write_text(arguments.output, html);
    if (!arguments.pdf.empty()) write_pdf(arguments, html, sheets.size());
    if (!common.json && !common.csv) return ExitCode::done;
  }
  if (common.json || common.csv) {
    print_answer(to_answer(sheets), common);
    return ExitCode::done;
  }
  for (const FaultSheet& one : sheets) {
    if (sheets.size() > 1) print_text(concat("Fault ", one.fault, "\n\n"));
    print_answer(to_answer({one}), common);
    if (sheets.size() > 1) print_text("\n");
  }
  return ExitCode::done;
}

}  // namespace

void add_sheet(Program& program) {
  auto [command, a] = program.add(
      "sheet", "what an authority asks about a fault, on one A4 page: the regulator sheet", sheet);
  add_campaign(command, program.common);
  command->add_option("--fault", a.request.fault,
                      "only this fault; default: all, each on a page of its own");
  command->add_option("-o,--output", a.output, "file to write: *.html, readable without a network");
  command->add_option("--pdf", a.pdf,
                      "file to write: *.pdf, printed by Chromium if that is installed");
  command->add_option("--levels", a.levels,
                      "table of escalation levels (JSON, schemas/levels.schema.json); default:\n"
                      "green, amber where chi_bar > 0.8, red where the fault slides");
  command->add_option("--datum", a.datum,
                      "depth to which pressures are referred: \"2100 m\"; default: the middle of\n"
                      "the reservoirs beside the fault");
  add_confidence(command, a.request.confidence);
  add_renderings(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep sheet my-sweep --fault F2                  on the screen\n"
      "  faultsweep sheet my-sweep -o sheets.html --pdf sheets.pdf\n"
      "  faultsweep sheet my-sweep --fault F2 --levels levels.json --datum \"2100 m\" -o f2.html");
}

}  // namespace faultsweep
