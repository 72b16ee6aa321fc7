#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "campaign/expansion/case_values.h"
#include "campaign/expansion/scene_builder.h"

/// Reading a scene takes 0.1 ms, planning it a few times that; a campaign may have 10^5. But what a
/// case's identity and its family are fingerprints of differs from its neighbour's text in a few
/// values only, so large designs read a few scenes per *choice*, note which values each choice
/// changes, and compose the texts of all rows from that.
namespace faultsweep {

/// A canonical scene cut at its values: between[0] leaf[0] between[1] leaf[1] ... between[n].
struct CanonicalPieces {
  std::vector<std::string> between;
  std::vector<std::string> leaves;
};
/// Cuts JSON text as nlohmann::json::dump() writes it: leaves are numbers, strings and literals
/// that are values, not keys.
CanonicalPieces cut_at_values(const std::string& json_text);

/// Texts of the rows of one group. Composing is trusted only after it was compared with the real
/// thing: every combination of extreme values (up to 128) and 32 rows spread over the design.
/// Parameters that change the shape of the text, or values that another one changes too, get a
/// template of their own per choice.
class Composer {
 public:
  /// JSON text of a checked scene; nothing where problems are appended.
  using Text = std::function<std::optional<std::string>(const faultsim::Scene&,
                                                        std::vector<faultsim::Problem>&)>;
  /// @param has_effect  per parameter of the group, and then per derived one: false = it never
  ///                    changes the text.
  Composer(const CampaignSpec& spec, const Group& group, SceneBuilder& builder,
           const CaseValues& values, Text text, std::vector<bool> has_effect);

  /// False when this group cannot be composed; then every row must be read. Problems are those of
  /// extreme combinations that are cases of a grid.
  bool prepare(std::vector<faultsim::Problem>& problems);
  /// The row's text, until the next call, or nothing where the scene must be read.
  std::optional<std::string_view> text(const Row& row, const std::vector<double>& derived);

 private:
  using Difference = std::vector<std::pair<std::size_t, std::string>>;  // leaf, its text
  /// What the choices of one parameter change in a template.
  struct Effect {
    bool is_number = false;  ///< every choice writes its own number into `leaves`.
    std::vector<std::size_t> leaves;
    std::unordered_map<int, std::optional<Difference>> known;
  };
  struct Template {
    Row reference;
    std::vector<double> derived;
    CanonicalPieces pieces;
    std::vector<Effect> effects;                           ///< per parameter.
    std::vector<std::vector<std::size_t>> derived_leaves;  ///< per derived parameter.
    std::vector<std::size_t> places;   ///< leaves that differ between rows seen, ascending,
    std::vector<std::string> between;  ///< and the text between them.
  };

  std::optional<std::string> exact_text(const Row& row, const std::vector<double>& derived,
                                        std::vector<faultsim::Problem>& problems);
  std::optional<Difference> read_difference(const Template& one, const Row& row,
                                            const std::vector<double>& derived);
  const std::optional<Difference>& difference(Template& one, std::size_t parameter, int choice);
  std::optional<Template> make_template(const Row& like);
  void find_number_effects(Template& one);
  bool find_derived_leaves(Template& one);
  bool find_structure();
  Template* template_of(const Row& row);
  bool find_changes(Template& one, const Row& row, const std::vector<double>& derived);
  void add_places(Template& one);
  std::vector<Row> rows_to_check() const;
  bool is_fixed(std::size_t parameter) const {
    return structural_[parameter] || !has_effect_[parameter];
  }

  const CampaignSpec& spec_;
  const Group& group_;
  SceneBuilder& builder_;
  const CaseValues& values_;
  Text text_of_;
  std::vector<bool> has_effect_;
  long n_rows_ = 0;
  Row reference_;
  std::vector<bool> structural_;                      ///< per parameter: has templates of its own.
  std::map<Row, std::optional<Template>> templates_;  ///< by the structural choices.
  /// Of the row at hand: leaves that differ from its template's, the later one where a leaf comes
  /// twice; the texts of numbers among them; the composed text.
  std::vector<std::pair<std::size_t, std::string_view>> changes_;
  std::vector<std::string> numbers_;
  std::string text_;
};

/// Up to n choices of a parameter, always with the first, last, smallest and largest.
std::vector<int> sample_choices(const Parameter& parameter, std::size_t n);

}  // namespace faultsweep
