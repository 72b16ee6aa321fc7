#include "campaign/serve/live_page.h"

#include "live_css.h"
#include "live_js.h"
#include "simulator/page/html_page.h"

namespace faultsweep::serve {

namespace embedded = faultsim::embedded;

HttpResponse live_page() {
  faultsim::HtmlPage page("faultsweep");
  page.may_ask_its_server();
  page.style(embedded::live_css);
  page.script(embedded::live_js, embedded::live_js_sha256);
  page.add(
      "<main id=\"view\"><p class=\"faint\">This page needs JavaScript. Without it, "
      "<code>faultsweep report</code> writes one that does not.</p></main>\n");
  HttpResponse response{200, "text/html; charset=utf-8", page.finish()};
  response.policy = page.policy();
  return response;
}

}  // namespace faultsweep::serve
