#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "campaign/serve/request.h"

namespace faultsweep {

namespace serve {
struct Listener;
}

/// How much a server does for whoever asks.
struct ServerLimits {
  std::size_t head_bytes = 8192;    ///< of a request line and its headers: 431 above.
  std::size_t target_bytes = 4096;  ///< of path and parameters: 414 above.
  /// When there are more, the one that has waited longest for its client is closed.
  std::size_t connections = 64;
  double head_seconds = 5;      ///< until a request is there; the connection is closed then.
  double send_seconds = 30;     ///< until its response has been taken; the same.
  double per_second = 200;      ///< requests that are answered, on average ...
  double at_once = 400;         ///< ... and in a burst: 429 above.
  std::size_t unanswered = 32;  ///< requests that wait for their answers: 503 above.
  int threads = 4;              ///< that answer, or wait for a simulator.
};

struct ServerSettings {
  int port = 0;  ///< 0 = any free one.
  ServerLimits limits = {};
  /// Called a few times a second; what it throws ends run().
  std::function<void()> watch = [] {};
  /// HttpResponse::remark of a response.
  std::function<void(const std::string&)> remark = [](const std::string&) {};
};

/// An HTTP server on 127.0.0.1 alone, for GET and HEAD without a body. A connection is for one
/// request, or for as many as its client says it has ("Connection: keep-alive"), one after the
/// other, until one of them is refused. Whoever is slow waits for itself: one thread waits for all
/// clients, others answer.
class HttpServer {
 public:
  /// The answer to a request, called from several threads at once; does not throw.
  using Handler = std::function<HttpResponse(const HttpRequest&)>;

  /// Listens from now on. Throws InputError where the port is taken, or not ours to take.
  HttpServer(ServerSettings settings, Handler handler);
  ~HttpServer();  ///< waits for the answers at work.
  int port() const;
  /// "http://127.0.0.1:8642/"
  std::string address() const;
  void run();   ///< until stop() or an exception of `watch`.
  void stop();  ///< from any thread.

 private:
  std::unique_ptr<serve::Listener> inside_;
};

}  // namespace faultsweep
