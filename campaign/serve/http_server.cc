#include "campaign/serve/http_server.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <list>
#include <optional>
#include <utility>

#include "campaign/common/names.h"

namespace faultsweep {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::beast::error_code;
using Clock = std::chrono::steady_clock;

constexpr const char* kName = "faultsweep";
constexpr double kWatchSeconds = 0.2;

Clock::duration duration_of(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

/// A bucket of requests that fills steadily.
class RateLimit {
 public:
  RateLimit(double per_second, double at_once)
      : per_second_(per_second), at_once_(at_once), left_(at_once) {}
  bool takes_one() {
    const Clock::time_point now = Clock::now();
    const double passed = std::chrono::duration<double>(now - since_).count();
    since_ = now;
    left_ = std::min(at_once_, left_ + per_second_ * passed);
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double per_second_, at_once_, left_;
  Clock::time_point since_ = Clock::now();
};

constexpr int kTooLarge = 413;
const HttpProblem kHasBody = {kTooLarge, "body", "requests have no body here",
                              "put parameters after ?, as NAME=TEXT"};

/// What a client sent that is not HTTP, or more of it than may be; none = it went away.
std::optional<HttpProblem> problem_of(const error_code& error) {
  const auto is = [&](http::error one) { return error == make_error_code(one); };
  if (is(http::error::header_limit) || is(http::error::buffer_overflow)) {
    constexpr int kHeadersTooLarge = 431;
    return HttpProblem{kHeadersTooLarge, "headers", "the request line and headers are too long",
                       "send a shorter condition, or fewer headers"};
  }
  if (is(http::error::bad_version)) {
    constexpr int kVersion = 505;
    return HttpProblem{kVersion, "request line", "this version of HTTP is not supported",
                       "use HTTP/1.1"};
  }
  if (is(http::error::body_limit)) return kHasBody;
  const bool is_ours = error.category() == make_error_code(http::error::bad_method).category();
  if (!is_ours || is(http::error::end_of_stream)) return std::nullopt;
  return HttpProblem{400, "request", concat("it is not HTTP: ", error.message()),
                     "use HTTP/1.1 with lines that end in CR LF"};
}

using Head = http::request<http::empty_body>;

std::vector<std::string> values_of(const Head& head, const char* name) {
  std::vector<std::string> values;
  const auto [begin, end] = head.equal_range(name);
  for (auto it = begin; it != end; ++it)
    values.emplace_back(it->value().data(), it->value().size());
  return values;
}

/// What may be asked of this server at all, whatever the path.
std::optional<HttpProblem> problem_of(const Head& head, bool has_body, const ServerLimits& limits,
                                      int port) {
  constexpr int kTooLong = 414, kNoSuchMethod = 405;
  if (head.target().size() > limits.target_bytes) {
    return HttpProblem{kTooLong, "path",
                       concat("it is longer than ", limits.target_bytes, " bytes"),
                       "shorten the request"};
  }
  if (head.method() != http::verb::get && head.method() != http::verb::head) {
    return HttpProblem{kNoSuchMethod, "method", "this server is read-only: GET and HEAD",
                       "use faultsweep on the command line to change something"};
  }
  if (has_body) return kHasBody;
  return refusal(
      {values_of(head, "Host"), values_of(head, "Origin"), values_of(head, "Sec-Fetch-Site")},
      port);
}

/// Whether the client may ask again on its connection: only who says that it means to. A page does,
/// which asks many times a second; whatever is wrong ends its connection.
bool is_kept(const Head& head, const HttpResponse& response) {
  return response.status < 400 && head.keep_alive() &&
         http::token_list(head[http::field::connection]).exists("keep-alive");
}

template <typename Body>
void add_headers(http::response<Body>& to, const HttpResponse& from, bool is_kept) {
  to.set(http::field::server, kName);
  to.set(http::field::content_type, from.type);
  to.set(http::field::cache_control, "no-store");
  to.set("Content-Security-Policy", from.policy + "; frame-ancestors 'none'");
  to.set("X-Content-Type-Options", "nosniff");
  to.set("X-Frame-Options", "DENY");
  to.set("Referrer-Policy", "no-referrer");
  to.set("Cross-Origin-Resource-Policy", "same-origin");
  to.set("Cross-Origin-Opener-Policy", "same-origin");
  constexpr int kNoSuchMethod = 405, kTooMany = 429, kBusy = 503;
  if (from.status == kNoSuchMethod) to.set(http::field::allow, "GET, HEAD");
  if (from.status == kTooMany || from.status == kBusy) to.set(http::field::retry_after, "1");
  to.set(http::field::connection, is_kept ? "keep-alive" : "close");
}

}  // namespace

namespace serve {

class Session;

/// All members are used by the thread of run() only, but `answers`.
struct Listener {
  Listener(ServerSettings asked, HttpServer::Handler answering)
      : settings(std::move(asked)),
        handler(std::move(answering)),
        rate(settings.limits.per_second, settings.limits.at_once),
        answers(static_cast<std::size_t>(settings.limits.threads)) {}

  void listen();
  void accept_next();
  void watch_next();
  void make_room();

  ServerSettings settings;
  HttpServer::Handler handler;
  RateLimit rate;
  std::size_t unanswered = 0;
  std::list<Session*> sessions;  ///< that have waited longest for their clients first.
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer pause{io}, tick{io};
  int port = 0;
  asio::thread_pool answers;  ///< ends before what its work refers to.
};

/// One connection and its requests, one after the other. It lives as long as something is awaited
/// for it.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, Listener& server);
  ~Session() { server_.sessions.erase(place_); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void read_head();
  bool waits_for_client() const { return !is_being_answered_ && !is_closed_; }
  void close() {
    is_closed_ = true;
    stream_.close();
  }

 private:
  void decide(const error_code& error);
  void ask(HttpRequest request);
  void send(const HttpResponse& response);
  template <typename Body>
  void write(http::response<Body>& message);
  void wait_for_end();

  Listener& server_;
  const ServerLimits& limits_;
  std::list<Session*>::iterator place_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;  ///< of one request.
  http::response<http::string_body> response_;
  http::response<http::empty_body> head_of_response_;
  bool is_being_answered_ = false, is_closed_ = false, is_head_ = false, is_kept_ = false;
  std::size_t left_to_skip_ = 0;
};

Session::Session(tcp::socket socket, Listener& server)
    : server_(server),
      limits_(server.settings.limits),
      place_(server.sessions.insert(server.sessions.end(), this)),
      stream_(std::move(socket)),
      buffer_(limits_.head_bytes) {}

void Session::read_head() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(limits_.head_bytes));
  server_.sessions.splice(server_.sessions.end(), server_.sessions, place_);
  stream_.expires_after(duration_of(limits_.head_seconds));
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](const error_code& error, std::size_t) { self->decide(error); });
}

void Session::decide(const error_code& error) {
  std::optional<HttpProblem> problem;
  if (error) {
    problem = problem_of(error);
    if (!problem) return;  // the client went away, or took too long
  } else {
    is_head_ = parser_->get().method() == http::verb::head;
    const bool has_body = parser_->chunked() || parser_->content_length().value_or(0) > 0;
    problem = problem_of(parser_->get(), has_body, limits_, server_.port);
  }
  if (problem) return send(error_response(*problem));
  try {
    const boost::beast::string_view target = parser_->get().target();
    ask(parse_target({target.data(), target.size()}));
  } catch (const HttpError& refused) {
    send(error_response(refused.problem()));
  }
}

void Session::ask(HttpRequest request) {
  constexpr int kTooMany = 429, kBusy = 503;
  if (server_.unanswered >= limits_.unanswered) {
    return send(error_response(
        {kBusy, "server", "too many requests are waiting for answers", "ask again in a second"}));
  }
  if (!server_.rate.takes_one()) {
    return send(error_response(
        {kTooMany, "server", "too many requests per second", "ask again in a second"}));
  }
  ++server_.unanswered;
  is_being_answered_ = true;
  asio::post(server_.answers, [self = shared_from_this(), asked = std::move(request)]() mutable {
    HttpResponse response = self->server_.handler(asked);
    asio::io_context& io = self->server_.io;  // self goes with the work, to die in its thread
    asio::post(io, [self = std::move(self), response = std::move(response)] {
      --self->server_.unanswered;
      self->is_being_answered_ = false;
      if (!response.remark.empty()) self->server_.settings.remark(response.remark);
      self->send(response);
    });
  });
}

void Session::send(const HttpResponse& response) {
  stream_.expires_after(duration_of(limits_.send_seconds));
  is_kept_ = is_kept(parser_->get(), response);
  if (is_head_) {
    head_of_response_ = {static_cast<http::status>(response.status), 11};
    add_headers(head_of_response_, response, is_kept_);
    head_of_response_.content_length(response.body.size());
    return write(head_of_response_);
  }
  response_ = {static_cast<http::status>(response.status), 11};
  add_headers(response_, response, is_kept_);
  response_.body() = response.body;
  response_.prepare_payload();
  write(response_);
}

template <typename Body>
void Session::write(http::response<Body>& message) {
  http::async_write(stream_, message,
                    [self = shared_from_this()](const error_code& error, std::size_t) {
                      if (error) return;
                      if (self->is_kept_) return self->read_head();
                      error_code ignored;  // the client may be gone
                      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      self->left_to_skip_ = 16 * self->limits_.head_bytes;
                      self->stream_.expires_after(duration_of(1));
                      self->wait_for_end();
                    });
}

/// What a client still sends is read, for a while: closed at once, its system would throw away the
/// response together with the rest.
void Session::wait_for_end() {
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(limits_.head_bytes),
                          [self = shared_from_this()](const error_code& error, std::size_t n) {
                            if (error || n >= self->left_to_skip_) return;
                            self->left_to_skip_ -= n;
                            self->wait_for_end();
                          });
}

void Listener::listen() {
  const tcp::endpoint place(asio::ip::address_v4::loopback(),
                            static_cast<std::uint16_t>(settings.port));
  error_code error;
  acceptor.open(place.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  acceptor.bind(place, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error) {
    throw InputError("--port",
                     concat("cannot listen on port ", settings.port, ": ", error.message()),
                     "choose another port, or 0 for any free one");
  }
  port = acceptor.local_endpoint().port();
}

void Listener::accept_next() {
  acceptor.async_accept([this](const error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // no more files may be open, or the client is gone already
      pause.expires_after(duration_of(0.05));
      pause.async_wait([this](const error_code& stopped) {
        if (!stopped) accept_next();
      });
      return;
    }
    make_room();
    if (sessions.size() < 2 * settings.limits.connections)  // else they are all being answered
      std::make_shared<Session>(std::move(socket), *this)->read_head();
    accept_next();
  });
}

void Listener::make_room() {
  if (sessions.size() < settings.limits.connections) return;
  const auto longest =
      std::ranges::find_if(sessions, [](const Session* one) { return one->waits_for_client(); });
  if (longest != sessions.end()) (*longest)->close();  // leaves the list by itself
}

void Listener::watch_next() {
  tick.expires_after(duration_of(kWatchSeconds));
  tick.async_wait([this](const error_code& stopped) {
    if (stopped) return;
    settings.watch();
    watch_next();
  });
}

}  // namespace serve

HttpServer::HttpServer(ServerSettings settings, Handler handler)
    : inside_(std::make_unique<serve::Listener>(std::move(settings), std::move(handler))) {
  inside_->listen();
  inside_->accept_next();
  inside_->watch_next();
}

HttpServer::~HttpServer() {
  inside_->io.stop();
  inside_->answers.stop();
  inside_->answers.join();
}

int HttpServer::port() const { return inside_->port; }
std::string HttpServer::address() const { return concat("http://127.0.0.1:", port(), "/"); }
void HttpServer::run() { inside_->io.run(); }
void HttpServer::stop() {
  asio::post(inside_->io, [this] { inside_->io.stop(); });
}

}  // namespace faultsweep
