#include "answer.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <utility>

extern char** environ;

namespace resolution {
namespace {

using Clock = std::chrono::steady_clock;

/// Of positions, and of velocities relative to the largest speed; tables and bumps have sizes of
/// about 1.
constexpr double loose_error = 1e-3;

/// Granted beside what the program states, times the growth: positions and velocities of size 1 are
/// doubles, rounded in every step. With the default scheme at a sensible step the median of error
/// over growth is 1e-14.
constexpr double rounding_of_doubles = 1e-14;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Reads JSON objects and scalars into "outer.inner" keys; arrays are kept as text.
class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}
  std::map<std::string, std::string> read() {
    object("");
    return std::move(keys_);
  }

 private:
  void blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == ','))
      ++at_;
  }
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  std::string string() {
    std::string value;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\') ++at_;
      if (at_ < text_.size()) value += text_[at_];
    }
    ++at_;
    return value;
  }
  std::string array() {
    const std::size_t from = at_;
    int depth = 0;
    while (at_ < text_.size()) {
      if (text_[at_] == '"') {
        string();
        continue;
      }
      depth += (text_[at_] == '[') - (text_[at_] == ']');
      ++at_;
      if (depth == 0) break;
    }
    return text_.substr(from, at_ - from);
  }
  void object(const std::string& before) {
    blanks();
    if (next() != '{') throw std::runtime_error("no JSON object");
    ++at_;
    for (blanks(); next() == '"'; blanks()) {
      const std::string key = before + string();
      blanks();
      if (next() == ':') ++at_;
      blanks();
      if (next() == '{') {
        object(key + ".");
      } else if (next() == '[') {
        keys_[key] = array();
      } else if (next() == '"') {
        keys_[key] = string();
      } else {
        const std::size_t end = text_.find_first_of(",}\n ", at_);
        keys_[key] = text_.substr(at_, end - at_);
        at_ = end == std::string::npos ? text_.size() : end;
      }
    }
    if (next() == '}') ++at_;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::map<std::string, std::string> keys_;
};

double number(const Answer& answer, const std::string& key) {
  const auto found = answer.keys.find(key);
  if (found == answer.keys.end() || found->second == "null") return std::nan("");
  return std::strtod(found->second.c_str(), nullptr);
}

/// The error of position and velocity that the program states: the one place that decides what it
/// claims.
std::pair<double, double> stated_error(const Answer& answer) {
  if (answer.keys.contains("state_error.position"))
    return {number(answer, "state_error.position"), number(answer, "state_error.velocity")};
  // Programs without that key state the energy's error alone.
  const bool largest = answer.keys.contains("energy_error.largest");
  const double energy =
      std::fabs(number(answer, largest ? "energy_error.largest" : "energy_error"));
  const double error = std::fmax(1e-6, 100 * energy);
  return {error, error};
}

}  // namespace

const char* const verdict_names[verdicts] = {"agrees",  "loosely", "unresolved", "energy", "lost",
                                             "refused", "slow",    "crashed",    "beyond", "WRONG"};

Answer ask(const std::string& program, const std::string& file, double most_seconds) {
  Answer answer;
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  posix_spawn_file_actions_adddup2(&actions, err[1], 2);
  const std::string words[] = {program, "run", file, "--json"};
  char* arguments[5] = {};
  for (int i = 0; i < 4; ++i) arguments[i] = const_cast<char*>(words[i].c_str());
  pid_t child = 0;
  const int failed = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(out[1]);
  close(err[1]);
  if (failed != 0) throw std::runtime_error("cannot run " + program);

  const auto start = Clock::now();
  std::string texts[2];
  pollfd ends[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    const double left = most_seconds - seconds_since(start);
    if (left <= 0.0) {
      answer.too_slow = true;
      kill(child, SIGKILL);
      break;
    }
    if (poll(ends, 2, static_cast<int>(left * 1000) + 1) <= 0) continue;
    for (int i = 0; i < 2; ++i) {
      if (ends[i].fd < 0 || ends[i].revents == 0) continue;
      char buffer[4096];
      const ssize_t size = read(ends[i].fd, buffer, sizeof buffer);
      if (size <= 0)
        ends[i].fd = -1;
      else
        texts[i].append(buffer, static_cast<std::size_t>(size));
    }
  }
  close(out[0]);
  close(err[0]);
  int status = 0;
  waitpid(child, &status, 0);
  answer.seconds = seconds_since(start);
  if (WIFSIGNALED(status)) answer.signal = WTERMSIG(status);
  if (WIFEXITED(status)) answer.exit_status = WEXITSTATUS(status);
  answer.error = texts[1].substr(0, texts[1].find('\n'));
  if (texts[0].find('{') != std::string::npos) answer.keys = Reader(texts[0]).read();
  return answer;
}

Judgement judge(const Answer& answer, const Reference& reference) {
  Judgement result;
  const auto verdict = [&](Verdict v) {
    result.verdict = v;
    return result;
  };
  if (answer.too_slow) return verdict(Verdict::slow);
  if (answer.signal != 0) return verdict(Verdict::crashed);
  if (answer.exit_status == 1 && answer.keys.empty() && !answer.error.empty())
    return verdict(Verdict::refused);
  if (answer.keys.empty()) return verdict(Verdict::crashed);

  const auto as_double = [](Quad x) { return static_cast<double>(x); };
  result.position = std::hypot(as_double(Quad(number(answer, "x")) - reference.end.x),
                               as_double(Quad(number(answer, "y")) - reference.end.y));
  result.velocity = std::hypot(as_double(Quad(number(answer, "vx")) - reference.end.vx),
                               as_double(Quad(number(answer, "vy")) - reference.end.vy));
  std::tie(result.stated_position, result.stated_velocity) = stated_error(answer);

  const std::string& status = answer.keys.at("status");
  const double unresolved = number(answer, "unresolved_steps");
  if (status == "unresolved" || unresolved > 0.0) return verdict(Verdict::unresolved);
  const bool followed = status == "completed" || status == "pinned";
  if (!followed) return verdict(Verdict::lost);
  if (answer.exit_status == 3 || answer.keys.contains("note")) return verdict(Verdict::energy);
  if (answer.exit_status != 0) return verdict(Verdict::crashed);
  // Numbers that are not known (null) agree with nothing.
  const double rounding =
      rounding_of_doubles * reference.growth * std::fmax(1.0, reference.fastest);
  const bool within = result.position <= result.stated_position + rounding &&
                      result.velocity <= result.stated_velocity + rounding &&
                      number(answer, "t") == reference.t_end;
  // Runs that part from those with half the step before the end say so.
  if (answer.keys.contains("state_error.until") &&
      number(answer, "state_error.until") < reference.t_end)
    return verdict(Verdict::loosely);
  const double velocity_loose = loose_error * std::fmax(1.0, reference.fastest);
  if (!within) {
    const bool near = result.position <= loose_error && result.velocity <= velocity_loose;
    return verdict(near ? Verdict::beyond : Verdict::wrong);
  }
  const bool loose =
      result.stated_position > loose_error || result.stated_velocity > velocity_loose;
  return verdict(loose ? Verdict::loosely : Verdict::agrees);
}

}  // namespace resolution
