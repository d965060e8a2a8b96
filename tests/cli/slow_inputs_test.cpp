// Inputs that would take for ever: refused by their key, or ended by a signal wherever they are.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "cli/program.hpp"

namespace carom {
namespace {

void write(const Shell& shell, const std::string& text) {
  shell("cat > slow.toml <<'END'\n" + text + "END\n");
}

// A second after the signal every program has ended: after two it is killed. The shell's status of
// a program that a signal ended is 128 + the signal.
int status_when_terminated(const Shell& shell, const std::string& arguments,
                           const std::string& when = "until_listening") {
  const Outcome o = shell(
      "$carom " + arguments + " --quiet & pid=$!; " + when +
      "; sleep 0.5; kill -0 $pid || echo ended-too-soon; kill -TERM $pid; n=0; "
      "while kill -0 $pid && [ $n -lt 100 ]; do sleep 0.1; n=$((n + 1)); done 2>/dev/null; kill -9 "
      "$pid; wait $pid");
  EXPECT_EQ(o.out.find("ended-too-soon"), std::string::npos) << arguments << o.err;
  return o.status;
}

const std::string coulomb =
    "[table]\nshape = \"circle\"\nradius = 1\n[interaction]\nkind = \"coulomb\"\nstrength = 1\n";

TEST(SlowInputs, AreRefusedByTheirKey) {
  const Shell shell;
  const std::string lattice =
      "[[potential]]\nkind = \"fermi\"\nheight = 1\nradius = 0.3\nsoftness = 0.01\nlattice = "
      "true\n[integrator]\n"
      "step = 0.01\n[particles]\nenergy = 0.5\n[initial]\nkind = \"uniform\"\n";
  const std::pair<std::string, std::string> refused[] = {
      {"[table]\nshape = \"plane\"\n[lattice]\nvectors = [[1, 0], [0, 1.2e11]]\n" + lattice,
       "potential[0]"},
      {"[table]\nshape = \"circle\"\nradius = 1\n[run]\nt_max = 10\nsample = 5e-101\n",
       "run.sample"},
      {"[table]\nshape = \"circle\"\nradius = 1\n[field]\nB = 1e50\n[run]\nt_max = 10\n",
       "run.t_max"},
      {"[table]\nshape = \"rectangle\"\nwidth = 1e29\nheight = 1e29\n[run]\nt_max = 1e31\nsample = "
       "1\n",
       "run.sample"},
      {coulomb + "[particles]\ncount = 1000\nenergy = 12\n[integrator]\nstep = 0.001\n",
       "particles.energy"},
      {coulomb + "[particles]\ncount = 100000\nspeed = 1\n[integrator]\nstep = 0.001\n",
       "particles.count"},
      {"[table]\nshape = \"rectangle\"\nwidth = 100\nheight = 100\n[interaction]\nkind = "
       "\"hard-discs\"\nradius = 0.49\n"
       "[particles]\ncount = 10000\n",
       "particles.count"},
  };
  for (const auto& [text, key] : refused) {
    write(shell, text);
    const Outcome o = shell("$carom run ./slow.toml");
    EXPECT_EQ(o.status, 1) << text;
    EXPECT_NE(o.err.find(key + ":"), std::string::npos) << text << o.err;
  }
}

TEST(SlowInputs, SayTheLowestEnergySeenAndTheOneAskedFor) {
  const Shell shell;
  const Outcome o = shell("$carom run coulomb-circle --set particles.count=1000");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("12000"), std::string::npos) << o.err;
}

TEST(SlowInputs, EndByASignalBeforeThereIsAnArchive) {
  const Shell shell;
  // No arrangement is found, and many draws are needed to know it.
  write(shell, "[table]\nshape = \"random-discs\"\nside = 100\nradius = 0.4\ncount = 11000\n");
  EXPECT_EQ(status_when_terminated(shell, "run ./slow.toml -o a.h5", "sleep 0.5"), 128 + 15);
  EXPECT_FALSE(shell.exists("a.h5"));
}

// Long steps of many particles that hit walls; samples far shorter than a flight.
TEST(SlowInputs, EndByASignalInTheMiddleOfAStepAndBetweenSamples) {
  const Shell shell;
  write(shell, coulomb +
                   "[particles]\ncount = 4000\nspeed = 1\n[integrator]\nstep = "
                   "1e-4\nunresolved = \"count\"\nenergy_tolerance = 1e9\n[initial]\nkind = "
                   "\"uniform\"\n[run]\nt_max = 1\n");
  EXPECT_EQ(status_when_terminated(shell, "run ./slow.toml"), 130);
  EXPECT_EQ(status_when_terminated(shell, "escape ./slow.toml --trajectories 1 -o b.h5"), 130);
  write(shell,
        "[table]\nshape = \"rectangle\"\nwidth = 1e29\nheight = 1e29\n[initial]\nkind = "
        "\"uniform\"\n[run]\nt_max = 1e31\nsample = 1e17\n");
  EXPECT_EQ(status_when_terminated(shell, "run ./slow.toml"), 130);
}

// A pinned particle without a last time is where it starts.
TEST(SlowInputs, PinnedOrbitsHaveNumbers) {
  const Shell shell;
  const Outcome o = shell("$carom run lorentz-square --set field.B=1e59 --collisions 5 --json");
  EXPECT_EQ(json_value(o.out, "status"), "\"pinned\"");
  EXPECT_EQ(json_value(o.out, "t"), "0");
  for (const char* key : {"x", "y", "vx", "vy"}) EXPECT_NE(json_value(o.out, key), "null") << key;
}

}  // namespace
}  // namespace carom
