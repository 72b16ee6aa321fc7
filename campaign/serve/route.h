#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/common/json.h"
#include "campaign/serve/request.h"
#include "campaign/store/store.h"

/// Inside of the room: what can be asked for, and how what was asked is read.
namespace faultsweep::serve {

struct Parameter {
  const char* name;
  const char* meaning;
  bool may_repeat = false;
};

class Asked;

/// A path and who answers it.
struct Route {
  const char* path;  ///< "/api/campaigns/{campaign}": what is in braces may be anything.
  const char* meaning;
  std::vector<Parameter> parameters;  ///< others are refused.
  HttpResponse (*answer)(const Store&, const Asked&);
  const char* type = "application/json";
};

/// A request that goes a route, its parameters checked by name and number.
class Asked {
 public:
  /// Throws HttpError on a parameter that the route does not have, or has once.
  Asked(const Route& route, const HttpRequest& request);

  /// "" where it is not given.
  std::string text(const char* name) const;
  std::vector<std::string> texts(const char* name) const;
  bool flag(const char* name) const;  ///< "1", "true", "yes"; else "0", "false", "no".
  std::optional<long> whole(const char* name, long least, long most) const;
  std::optional<double> number(const char* name, double least, double most) const;
  /// One of the words, the first where it is not given: its index.
  std::size_t word(const char* name, const std::vector<std::string>& words) const;
  /// 0.95 where it is not given.
  double confidence() const;

  /// The campaign and the case of the path. Throws HttpError (404) where there is none.
  CampaignInfo campaign(const Store& store, bool with_counts = false) const;
  StoredCase stored_case(const Store& store, const CampaignInfo& campaign) const;

 private:
  std::optional<std::string> given(const char* name) const;
  const std::string& in_path(const char* braces) const;

  const Route& route_;
  const HttpRequest& request_;
};

const std::vector<Route>& answer_routes();   ///< JSON, or parts of a page.
const std::vector<Route>& drawing_routes();  ///< SVG.
const std::vector<Route>& page_routes();     ///< what only the page asks for.
/// Waits for a simulator and is answered by StoreApi itself; it has no function.
const Route& what_if_route();
/// Its question as schemas/what_if_protocol.md has it, without a number.
json question_body(const Asked& asked);
/// All of them, in this order.
std::vector<const Route*> all_routes();

}  // namespace faultsweep::serve
