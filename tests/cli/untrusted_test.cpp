// Results that cannot be trusted: their reports begin with it, and the exit status is 3.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "cli/reports/aligned.hpp"
#include "program.hpp"

namespace carom {
namespace {

bool holds(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}
bool begins_with(const std::string& text, const std::string& what) {
  return text.rfind(what, 0) == 0;
}
std::uint64_t whole(const std::string& json, const char* key) {
  return std::stoull(json_value(json, key));
}
/// The value of a key within the value of another.
double within(const std::string& json, const char* outer, const char* key) {
  const std::string object = json_value(json, outer), mark = std::string("\"") + key + "\": ";
  const std::size_t at = object.find(mark);
  return at == std::string::npos ? std::nan("") : std::stod(object.substr(at + mark.size()));
}

// A typed well that is no number right of x = 1/2: the step that comes there fails.
const char* const half = R"(cat > half.toml << 'END'
[table]
shape = "rectangle"
width = 1
height = 1
[[potential]]
kind = "expression"
expression = "0*sqrt(1/2 - x) + y^2/8"
[particles]
speed = 1
[initial]
kind = "rectangle"
min = [0.2, 0.1]
max = [0.45, 0.9]
[integrator]
step = 0.01
[run]
t_max = 0.2
trajectories = 100
END
)";

TEST(Untrusted, UnresolvedTrajectoriesComeFirst) {
  const Shell shell;
  shell(half);
  for (const char* command : {"escape", "diffusion", "section --on y=0.5 --orbits 100"}) {
    const std::string line = std::string("$carom ") + command + " ./half.toml ";
    const Outcome json = shell(line + "--json"), text = shell(line);
    EXPECT_EQ(json.status, 3) << command << json.err;
    EXPECT_EQ(text.status, 3) << command;
    const std::uint64_t unresolved = whole(json.out, "unresolved");
    EXPECT_GT(unresolved, 10u) << command;
    EXPECT_EQ(whole(json.out, "lost"), 0u) << command;
    const std::string first = on_one_line(text.out).substr(0, 300);
    EXPECT_TRUE(holds(first, std::to_string(unresolved))) << first;
    EXPECT_FALSE(holds(text.out, "0x") || holds(text.err, "0x") ||
                 holds(text.out, "internal error"))
        << text.out << text.err;
    const std::string reports = json_value(json.out, "reports");
    EXPECT_TRUE(holds(reports, "\"index\"") && holds(reports, "\"reason\"") &&
                holds(reports, "\"state\": \"wall ") && holds(reports, "0x"))
        << reports;
    if (begins_with(command, "escape")) {
      std::uint64_t sum = 0;
      for (const char* fate : {"escaped", "survived", "singular", "unresolved", "lost"})
        sum += whole(json.out, fate);
      EXPECT_EQ(sum, whole(json.out, "trajectories"));
    }
  }
  // Of one trajectory: the reason, then the state.
  const std::string start = "$carom run ./half.toml --position 0.45,0.5 --velocity 1,0 ";
  const Outcome one = shell(start + "--json"), text = shell(start + "-o a.h5");
  EXPECT_EQ(one.status, 3);
  EXPECT_EQ(json_value(one.out, "status"), "\"unresolved\"");
  EXPECT_TRUE(holds(json_value(one.out, "state"), "0x")) << one.out;
  const std::string reason = json_value(one.out, "reason");
  ASSERT_GT(reason.size(), 2u);
  EXPECT_TRUE(begins_with(on_one_line(text.out), reason.substr(1, reason.size() - 2))) << text.out;
  EXPECT_FALSE(holds(text.out, "0x")) << text.out;
  const Outcome again = shell("$carom run --resume a.h5 --t-max 1");
  EXPECT_EQ(again.status, 3);
  EXPECT_NE(again.err, "");
}

// A group fails at once: its reason is said once, in lines that fit.
TEST(Untrusted, ReasonsAreSaidOnceAndShort) {
  const Shell shell;
  const Outcome group = shell(
      "$carom diffusion wigner --trajectories 3 --t-max 1 --quiet --set "
      "integrator.step=0.9");
  EXPECT_EQ(group.status, 3);
  const auto times = [](const std::string& text, const std::string& what) {
    std::size_t number = 0;
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++number;
    return number;
  };
  EXPECT_EQ(times(group.err, "does not resolve"), 1u) << group.err;
  EXPECT_TRUE(holds(group.err, "14 more could not be followed")) << group.err;
  const Outcome apart = shell(
      "$carom escape soft-lorentz --trajectories 50 --quiet --t-max 9 --set integrator.step=0.9");
  EXPECT_EQ(times(on_one_line(apart.err), "does not resolve"), 3u) << apart.err;
  for (const std::string& text : {group.err, apart.err, group.out, apart.out})
    EXPECT_LE(cli::width_of(text), cli::line_width) << text;
}

TEST(Untrusted, AreKeptByArchivesAndMerges) {
  const Shell shell;
  shell(half);
  for (const std::string command : {"escape", "diffusion"}) {
    const Outcome whole_run = shell("$carom " + command + " ./half.toml --json -o all.h5 --force");
    shell("$carom " + command + " ./half.toml --shard 1/2 -o a.h5 --force; $carom " + command +
          " ./half.toml --shard 2/2 -o b.h5 --force");
    const Outcome merged = shell("$carom merge sum.h5 a.h5 b.h5 --json --force"),
                  read = shell("$carom " + command + " --resume all.h5 --json");
    for (const Outcome* o : {&merged, &read}) {
      EXPECT_EQ(o->status, 3) << o->err;
      for (const char* key : {"unresolved", "lost", "reports", "energy_error", "steps",
                              "force_evaluations", "digest"})
        EXPECT_EQ(json_value(o->out, key), json_value(whole_run.out, key)) << command << ' ' << key;
    }
  }
}

TEST(Untrusted, EnergiesBeyondTheirToleranceComeFirst) {
  const Shell shell;
  for (const char* command :
       {"run soft-lorentz --t-max 20", "escape soft-lorentz --t-max 20 --trajectories 20",
        "diffusion soft-lorentz --t-max 20 --trajectories 20",
        "section soft-lorentz --t-max 20 --on vx=0 --orbits 5"}) {
    const std::string line = std::string("$carom ") + command;
    const Outcome usual = shell(line + " --json"),
                  strict = shell(line + " --set integrator.energy_tolerance=1e-14");
    EXPECT_EQ(usual.status, 0) << command << usual.err;
    EXPECT_LT(within(usual.out, "energy_error", "largest"), 1e-5) << command;
    EXPECT_GT(within(usual.out, "energy_error", "largest"), 1e-14) << command;
    EXPECT_GE(within(usual.out, "energy_error", "largest"),
              std::abs(within(usual.out, "energy_error", "end")))
        << command;
    EXPECT_EQ(strict.status, 3) << command;
    const auto first_line = [](const Outcome& o) { return o.out.substr(0, o.out.find('\n')); };
    EXPECT_NE(first_line(strict), first_line(shell(line))) << "the doubt comes first";
  }
  // An orbit that comes back to where it began: the error lies between.
  const Outcome o = shell(
      "$carom run henon-heiles --t-max 100 --set integrator.scheme=velocity-verlet --set "
      "integrator.step=0.05 --json");
  EXPECT_GT(within(o.out, "energy_error", "largest"),
            std::abs(within(o.out, "energy_error", "end")));
}

TEST(Untrusted, StepsAreCounted) {
  const Shell shell;
  for (const char* command :
       {"run soft-lorentz --t-max 20", "escape soft-lorentz --t-max 20 --trajectories 20",
        "diffusion soft-lorentz --t-max 20 --trajectories 20",
        "section soft-lorentz --t-max 20 --on vx=0 --orbits 5"}) {
    const std::string line = std::string("$carom ") + command;
    const Outcome o = shell(line + " --json"), text = shell(line);
    EXPECT_GE(whole(o.out, "steps"), 150u) << command;
    EXPECT_GT(whole(o.out, "force_evaluations"), 10 * whole(o.out, "steps")) << command;
    EXPECT_EQ(json_value(o.out, "unresolved_steps"), "") << command;
    EXPECT_EQ(text.status, 0);
    const Outcome counted = shell(line + " --json --set integrator.unresolved=count");
    EXPECT_EQ(json_value(counted.out, "unresolved_steps"), "0") << command << counted.err;
    EXPECT_EQ(json_value(counted.out, "first_unresolved"), "null") << command;
  }
  EXPECT_TRUE(
      holds(shell("$carom escape soft-lorentz --t-max 20 --trajectories 20").out, "steps/s"));
  for (const char* command :
       {"run stadium --t-max 20", "escape stadium --t-max 20 --trajectories 20"}) {
    const Outcome o = shell(std::string("$carom ") + command + " --json");
    for (const char* key : {"steps", "force_evaluations", "unresolved_steps", "reports"})
      EXPECT_EQ(json_value(o.out, key), "") << command;
  }
}

// A run that goes on counts on, and knows the energy that it began with.
TEST(Untrusted, RunsThatGoOnCountOn) {
  const Shell shell;
  const std::string run =
      "$carom run henon-heiles --set integrator.scheme=velocity-verlet --set "
      "integrator.step=0.05 ";
  const Outcome at_once = shell(run + "--t-max 60 --json");
  shell(run + "--t-max 20 -o a.h5");
  const Outcome parts = shell("$carom run --resume a.h5 --t-max 60 --json");
  EXPECT_EQ(parts.status, 0) << parts.err;
  for (const char* key : {"x", "vy", "steps"})
    EXPECT_EQ(json_value(parts.out, key), json_value(at_once.out, key)) << key;
  for (const char* key : {"end", "largest"}) {
    const double first = within(at_once.out, "energy_error", key);
    EXPECT_NEAR(within(parts.out, "energy_error", key), first, 1e-12) << key;
    EXPECT_NE(first, 0.0);
  }
  EXPECT_GE(whole(parts.out, "force_evaluations"), whole(at_once.out, "force_evaluations"));
  EXPECT_LE(whole(parts.out, "force_evaluations"), whole(at_once.out, "force_evaluations") + 3);
}

// The error is that of the whole run, from its start on: also where that was drawn, the step chosen
// or the scheme adaptive.
TEST(Untrusted, RunsThatGoOnSayTheErrorOfTheWholeRun) {
  const Shell shell;
  shell(R"(cat > hill.toml <<'END'
[table]
shape = "rectangle"
width = 2
height = 1
[[potential]]
kind = "gaussian"
height = 0.3
width = 0.2
center = [1, 0.5]
[particles]
speed = 1
[initial]
kind = "uniform"
END)");
  for (const char* how : {"", " --set integrator.scheme=arkode --set integrator.tolerance=1e-9",
                          " --set integrator.step=0.02 --seed 3"}) {
    // Steps of no fixed length are others after a rest.
    const bool adaptive = std::string(how).find("arkode") != std::string::npos;
    const std::string run = std::string("$carom run hill.toml --trajectory 5 --json") + how;
    const Outcome at_once = shell(run + " --t-max 20");
    shell(run + " --t-max 7 -o a.h5 --force");
    shell("$carom run --resume a.h5 --t-max 15");
    const Outcome parts = shell("$carom run --resume a.h5 --t-max 20 --json");
    EXPECT_EQ(parts.status, 0) << parts.err;
    for (const char* key : {"position", "velocity"}) {
      const double error = within(at_once.out, "state_error", key);
      EXPECT_GT(error, 0.0);
      EXPECT_NEAR(within(parts.out, "state_error", key), error, adaptive ? 0.5 * error : 0.0)
          << how;
    }
    EXPECT_TRUE(adaptive || json_value(parts.out, "x") == json_value(at_once.out, "x")) << how;
    EXPECT_EQ(json_value(parts.out, "state_error_reason"), "");
    EXPECT_NE(shell("$carom run --resume a.h5 --t-max 20").out.find("\n  state error   "),
              std::string::npos);
  }
}

TEST(Untrusted, AnInterruptedRunSaysWhyItHasNoStateError) {
  const Shell shell;
  const Outcome o = shell(
      "$carom run henon-heiles --t-max 1e9 -o a.h5 --json --quiet & pid=$!; until_there a.h5; "
      "sleep 1; kill -TERM $pid; wait $pid");
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_EQ(json_value(o.out, "state_error"), "null") << o.out;
  EXPECT_EQ(json_value(o.out, "state_error_reason"), "\"interrupted\"");
}

}  // namespace
}  // namespace carom
