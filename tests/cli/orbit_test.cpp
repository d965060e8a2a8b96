// carom orbit as a user sees it.
#include <gtest/gtest.h>

#include <string>

#include "archive_contents.hpp"
#include "program.hpp"

namespace carom {
namespace {

TEST(Orbit, PrintsItsKeysAndStoresItsOrbits) {
  const Shell shell;
  const std::string command = "$carom orbit three-disc --hits 4 --zeta --json ";
  const Outcome o = shell(command + "-o a.h5");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(is_json_object(o.out));
  EXPECT_EQ(json_value(o.out, "words"), "8");
  EXPECT_EQ(json_value(o.out, "symmetries"), "6");
  EXPECT_EQ(json_value(o.out, "shadowed"), "0");
  for (const char* key : {"version", "seconds", "orbits", "zeta", "archive", "status"})
    EXPECT_NE(json_value(o.out, key), "") << key;
  for (const char* key : {"\"period\":", "\"trace\":", "\"stability\":", "\"multipliers\":",
                          "\"action\":", "\"reduced\":", "\"points\":", "\"escape_rate\":"})
    EXPECT_NE(o.out.find(key), std::string::npos) << key;
  expect_refused(shell(command + "-o a.h5"), "a.h5");
  const Outcome text = shell("$carom orbit three-disc --hits 3");
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("hyperbolic"), std::string::npos);
}

TEST(Orbit, IsNamedByItsWord) {
  const Shell shell;
  const Outcome text = shell("$carom orbit three-disc --hits 6");
  for (const char* word :
       {" 12\n", " 123\n", " 1213\n", " 121323\n", "1 is disc_1, 2 is disc_2, 3 is disc_3"})
    EXPECT_NE(text.out.find(word), std::string::npos) << word << text.out;
  const Outcome json = shell("$carom orbit three-disc --hits 4 --json");
  EXPECT_NE(json.out.find("\"word\": \"1213\""), std::string::npos);
}

TEST(Orbit, RefusesWhatItCannotLookFor) {
  const Shell shell;
  for (const char* arguments :
       {"orbit henon-heiles", "orbit coulomb-circle", "orbit soft-lorentz",
        "orbit siam-photon --zeta", "orbit stadium --hits 1", "orbit stadium --hits x",
        "orbit stadium --tries 0", "orbit three-disc --hits 30", "orbit stadium --zeta"}) {
    const Outcome o = shell("$carom " + std::string(arguments) + " -o none.h5");
    EXPECT_EQ(o.status, 1) << arguments;
    EXPECT_EQ(o.out, "") << arguments;
    EXPECT_NE(o.err, "") << arguments;
  }
  EXPECT_NE(shell("ls none.h5").status, 0);
}

TEST(Orbit, FindsTheBouncingBallsOfAMagneticSquare) {
  const Shell shell;
  const Outcome o = shell("$carom orbit magnetic-square --hits 2 --starts 500 --tries 50 --json");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("\"family\": true"), std::string::npos) << o.out;
}

// Stopped while it flies the starts of its search, whose hits are far apart.
TEST(Orbit, IsInterruptedWhileItPrepares) {
  const Shell shell;
  const Outcome o = shell(
      "$carom orbit sinai --set table.radius=1e-9 --hits 3 --json --quiet -o a.h5 & pid=$!; "
      "until_listening; sleep 0.2; kill $pid; wait $pid");
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"") << o.err;
  EXPECT_EQ(open_archive(shell.folder() + "/a.h5").complete, 0);
}

}  // namespace
}  // namespace carom
