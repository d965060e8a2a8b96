// What the program prints for people: digits, width, length, and what stands where.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "base/counted.hpp"
#include "carom/files/system_file.hpp"
#include "cli/program.hpp"
#include "cli/reports/aligned.hpp"

namespace carom {
namespace {

using base::counted;
using cli::rounding_of;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// (1) The rounded number is within half a unit of the second digit of its error. (2) That digit is
// printed.
TEST(Digits, AreThoseThatTheErrorAllows) {
  for (int e = -12; e < 6; ++e)
    for (double value : {1.0, 1.2345678, 7.654321, 9.9999})
      for (double share : {0.5, 0.1, 0.0123, 1e-4}) {
        const double size = value * std::pow(10.0, e), error = share * size;
        const std::string text = rounding_of(size, error)(size);
        const double unit = std::pow(10.0, std::floor(std::log10(error)) - 1);
        EXPECT_LE(std::fabs(std::strtod(text.c_str(), nullptr) - size),
                  0.51 * std::max(unit, size >= 1e-3 && size < 1e6 ? 1e-15 : 0.0))
            << text;
        EXPECT_LE(text.size(), 14u) << text;
      }
  EXPECT_EQ(rounding_of(0.123456789, 0.00032)(0.123456789), "0.12346");
  EXPECT_EQ(rounding_of(1.23456e-7, 3e-8)(1.23456e-7), "1.23e-07");
  EXPECT_EQ(rounding_of(1.23456e-7, 3e-8)(0.0), "0");
  EXPECT_EQ(cli::with_error(0.169934, 0.00031), "0.16993 +- 0.00031");
  EXPECT_EQ(cli::with_error(4.5678e-8, 1.2e-9), "4.57e-08 +- 1.2e-09");
  EXPECT_EQ(cli::with_error(2.0, 1.23e-13), "2.000000000 +- 1.2e-13");
  EXPECT_EQ(cli::with_error(0.142640387289, 3.04e-10), "0.1426403873 +- 3.0e-10");
}

TEST(Digits, OfPercentagesAreThosePeopleWrite) {
  for (const auto& [share, text] : {std::pair{1.0, "100"},
                                    {0.9996, "100"},
                                    {0.994, "99"},
                                    {-1.234, "-123"},
                                    {0.12, "12"},
                                    {0.0512, "5.1"},
                                    {0.00031, "0.031"},
                                    {0.0, "0"}})
    EXPECT_EQ(cli::in_percent(share), text);
  EXPECT_EQ(cli::in_percent(0.97, 1), "97");
  EXPECT_EQ(cli::in_percent(0.052, 1), "5");
}

TEST(Digits, TellTimesApart) {
  EXPECT_EQ(cli::times_text({0.1, 1e6}), (std::vector<std::string>{"0.1", "1e+06"}));
  EXPECT_EQ(cli::times_text({1234567.1, 1234567.2}),
            (std::vector<std::string>{"1234567.1", "1234567.2"}));
}

TEST(Words, FollowTheirNumber) {
  const std::pair<const char*, const char*> nouns[] = {{"orbit", "orbits"},
                                                       {"trajectory", "trajectories"},
                                                       {"equilibrium", "equilibria"},
                                                       {"search", "searches"},
                                                       {"process", "processes"}};
  for (const auto& [one, many] : nouns) {
    EXPECT_EQ(counted(1, one), std::string("1 ") + one);
    EXPECT_EQ(counted(0, one), std::string("0 ") + many);
    EXPECT_EQ(counted(12345, one), std::string("12 345 ") + many);
  }
  const Shell shell;
  for (const char* command :
       {"escape stadium --trajectories 1 --t-max 1", "lyapunov sinai --trajectories 1 --t-max 5",
        "diffusion sinai --trajectories 1 --t-max 1", "section stadium --orbits 1 --points 1",
        "run stadium --closed --collisions 1", "orbit three-disc --hits 2",
        "relax wigner --starts 1 --set particles.count=1", "compare stadium --closed --t-max 1",
        "run stadium --closed --collisions 1 --precision certified --digits 1"}) {
    const Outcome o = shell(std::string("$carom ") + command + " --quiet");
    std::smatch found;
    EXPECT_FALSE(std::regex_search(o.out, found, std::regex("(^|[^.0-9])1 [a-z]+(ies|[^s]s)\\b")))
        << found[0] << '\n'
        << o.out;
    EXPECT_NE(o.out, "") << command << o.err;
  }
}

TEST(Lines, FitATerminal) {
  const Shell shell;
  std::vector<std::string> commands{
      "systems",
      "orbit three-disc --hits 4 --zeta --verbose",
      "orbit magnetic-square --hits 3 --starts 500 --tries 50 --verbose",
      "section siam-photon --set 'initial={kind=\"uniform\"}' --orbits 9",
      "compare coulomb-circle --schemes yoshida-6 --t-max 0.05",
      "schemes",
      "diffusion stadium --trajectories 40 --t-max 3 --verbose",
      "diffusion magnetic-square --trajectories 40 --t-max 3",
      "diffusion circle --trajectories 500 --t-max 50",
      "lyapunov circle --closed --trajectories 100 --t-max 100",
      "escape stadium --trajectories 3e6 --t-max 5 --verbose",
      "run stadium --closed --t-max 30 --set particles.count=300 --verbose",
      "run stadium --closed --t-max 1e5 --set particles.count=3",
      "--help"};
  for (const char* command :
       {"escape", "run", "diffusion", "lyapunov", "section", "relax", "compare", "schemes", "orbit",
        "merge", "table", "plot", "animate", "page", "systems", "validate"})
    commands.push_back(std::string(command) + " --help");
  for (const std::string& command : commands) {
    const Outcome o = shell("$carom " + command);
    EXPECT_EQ(o.status, 0) << command << o.err;
    EXPECT_LE(cli::width_of(o.out), cli::line_width) << command << '\n' << o.out;
  }
}

// (1) Every line of a table fits, (2) no column is lost, (3) each table begins with the first one,
// and (4) what belongs together stays so.
TEST(Lines, OfWideTablesFollowBelow) {
  for (std::size_t width = 1; width < 36; ++width) {
    std::vector<cli::Column> columns{{"row", {"1", "2"}}};
    for (int c = 0; c < 6; ++c)
      columns.push_back({"c" + std::to_string(c),
                         {std::string(width, 'x'), std::string(width, 'y')},
                         false,
                         c % 2 == 1});
    const std::string text = cli::fitted(columns);
    EXPECT_LE(cli::width_of(text), cli::line_width) << text;
    std::size_t tables = 0, headers = 0;
    for (const std::string& line : lines_of(text)) {
      if (!line.starts_with("  row")) continue;
      ++tables;
      for (int c = 0; c < 6; ++c) {
        const bool here = line.find("c" + std::to_string(c)) != std::string::npos;
        headers += here;
        const bool next = line.find("c" + std::to_string(c + 1)) != std::string::npos;
        EXPECT_TRUE(c % 2 == 1 || here == next) << line;
      }
    }
    EXPECT_EQ(headers, 6u) << text;
    EXPECT_EQ(tables, width <= 10 ? 1u : width <= 16 ? 2u : 3u) << width << text;
    EXPECT_TRUE(tables > 1 || text == cli::aligned(columns));
  }
}

TEST(Rows, KeepTheLastAndAreFew) {
  for (std::size_t all = 1; all < 100; ++all) {
    const auto kept = cli::every_kth(all, 12);
    EXPECT_LE(kept.size(), 12u);
    EXPECT_GE(kept.size(), std::min<std::size_t>(all, 6));
    EXPECT_EQ(kept.back(), all - 1);
  }
}

// Half of a table of rare survival used to read 0.000000.
TEST(Reports, RareSurvivalHasDigits) {
  const Shell shell;
  const Outcome o = shell(
      "$carom escape stadium --trajectories 2e4 --t-max 1000 --times 900,1000 --set "
      "table.hole[0].width=0.5 --seed 3");
  int small = 0;
  for (const std::string& line : lines_of(o.out))
    small += std::regex_search(line, std::regex("^ +(900|1000)  [1-9][.0-9]*e-0[4-6]  "));
  EXPECT_EQ(small, 2) << o.out;
}

// A rate is that since the row above, also where rows are left out.
TEST(Reports, RatesAreThoseSinceTheRowAbove) {
  const Shell shell;
  const std::string command = "$carom escape magnetic-square --trajectories 2e4 --t-max 100";
  const auto lines = lines_of(shell(command).out);
  double t = 0.0, p = 1.0;
  int rows = 0;
  for (const std::string& line : lines) {
    std::smatch found;
    const std::regex row("^ +([0-9.]+)  +([0-9.]+)  +[0-9.]+ \\.\\. [0-9.]+ +([0-9.e-]+)  ");
    if (!std::regex_search(line, found, row)) continue;
    const double next = std::stod(found[1]), share = std::stod(found[2]);
    EXPECT_NEAR(std::stod(found[3]), (p - share) / (next - t), 3e-4 / (next - t)) << line;
    t = next;
    p = share;
    ++rows;
  }
  EXPECT_EQ(rows, 11);
  EXPECT_EQ(t, 100.0);
  EXPECT_NE(shell(command).out.find("the row above"), std::string::npos);
  int all = 0;
  for (const std::string& line : lines_of(shell(command + " --verbose").out))
    all += line.find(" .. ") != std::string::npos;
  EXPECT_EQ(all, 31);
}

// But for the title, which is prose, no line wraps, and a report is seen as a whole.
TEST(Reports, FitTheScreen) {
  const Shell shell;
  const auto expect_fit = [&](const std::string& command, std::size_t most_lines) {
    const Outcome o = shell("$carom " + command);
    EXPECT_EQ(o.status, 0) << command << o.err;
    const auto lines = lines_of(o.out);
    EXPECT_LE(lines.size(), most_lines) << command << "\n" << o.out;
    for (std::size_t i = 1; i < lines.size(); ++i)
      EXPECT_LE(cli::width_of(lines[i]), cli::line_width) << command << "\n" << lines[i];
  };
  for (const BuiltinSystem& system : builtin_systems()) {
    const std::string name(system.name);
    const bool particles = name == "coulomb-circle" || name == "wigner";
    expect_fit("run " + name + " --t-max 2", particles ? 40 : 16);
    expect_fit("escape " + name + " --trajectories 3 --t-max 2 --seed 3", 34);
    if (name == "coulomb-circle" || name == "wigner") continue;
    expect_fit("table " + name, 26);
  }
  for (const char* gas : {"lorentz-triangular", "lorentz-square", "soft-lorentz"})
    expect_fit(std::string("diffusion ") + gas + " --trajectories 200 --t-max 20", 39);
  expect_fit("section ellipse-magnetic --points 20", 22);
  expect_fit("orbit three-disc", 24);
  expect_fit("orbit ellipse-magnetic --hits 3 --starts 500 --tries 50", 24);
  expect_fit(
      "escape magnetic-square --trajectories 300 --t-max 30 --collisions 5 --set "
      "field.larmor_radius=0.1",
      36);
  expect_fit("escape stadium --splitting lin:0:50:11 --population 200", 40);
  expect_fit("run magnetic-square --closed --collisions 1000 --set particles.count=40", 30);
  expect_fit("escape stadium --trajectories 3e6 --t-max 5", 34);
  expect_fit("diffusion stadium --trajectories 40 --t-max 3", 39);
  expect_fit("schemes", 80);
  expect_fit("validate --scale 0.001", 300);
}

// Decisions, lanes and the digest are printed with --verbose alone; the JSON always has them.
TEST(Reports, ShowTheirInnerWorksOnlyWhenAsked) {
  const Shell shell;
  for (const std::string command :
       {"escape stadium --trajectories 100 --t-max 9",
        "diffusion lorentz-triangular --trajectories 100 --t-max 9",
        "section stadium --closed --points 10", "run stadium --t-max 9"}) {
    const Outcome plain = shell("$carom " + command);
    const Outcome all = shell("$carom " + command + " --verbose");
    for (const char* word : {"digest", "lanes", "decisions"})
      EXPECT_EQ(plain.out.find(word), std::string::npos) << command << word;
    EXPECT_NE(all.out.find("decisions"), std::string::npos) << command;
    if (command.starts_with("run")) continue;
    EXPECT_NE(all.out.find("digest"), std::string::npos) << command;
    EXPECT_NE(json_value(shell("$carom " + command + " --json").out, "digest"), "") << command;
  }
}

TEST(Reports, SeveralParticlesAreATable) {
  const Shell shell;
  const std::string command = "$carom run sinai --set particles.count=25 --t-max 20";
  const auto lines = lines_of(shell(command).out);
  int rows = 0;
  for (const std::string& line : lines)
    rows += std::regex_search(line, std::regex("^ +[0-9]+  completed "));
  EXPECT_EQ(rows, 20);
  EXPECT_NE(shell(command).out.find("and 5 more"), std::string::npos);
  EXPECT_NE(shell(command + " --verbose").out.find("\n        24  completed"), std::string::npos);
}

TEST(Reports, StepsAreCountedWhereNothingHits) {
  const Shell shell;
  const Outcome o = shell("$carom diffusion soft-lorentz --trajectories 20 --t-max 2");
  EXPECT_NE(o.out.find("steps/s"), std::string::npos) << o.out;
  EXPECT_EQ(o.out.find("hits/s"), std::string::npos) << o.out;
}

// Of fewer quasi-random starts than replicates there is a result, but no error.
TEST(Reports, SayWhyQuasiRandomStartsGiveNoError) {
  const Shell shell;
  const std::pair<const char*, const char*> commands[] = {
      {"lyapunov sinai", "errors by 16 replicates"},
      {"escape stadium", "intervals by 16 replicates"}};
  for (const auto& [command, errors] : commands) {
    const std::string few = std::string("$carom ") + command +
                            " --t-max 20 --quiet --set initial.kind=sobol --trajectories ";
    const std::string why = "16 replicates of the quasi-random starts, and 1 of them";
    const Outcome none = shell(few + "15"), enough = shell(few + "16");
    EXPECT_NE(on_one_line(none.out).find(why), std::string::npos) << none.out;
    EXPECT_EQ(none.out.find(errors), std::string::npos) << none.out;
    EXPECT_NE(enough.out.find(errors), std::string::npos) << enough.out;
    EXPECT_NE(json_value(shell(few + "15 --json").out, "no_errors").find(why), std::string::npos);
    EXPECT_EQ(json_value(shell(few + "16 --json").out, "no_errors"), "");
    const std::string swept = " --sweep run.seed=list:1,2";
    const Outcome rows = shell(few + "15" + swept);
    EXPECT_NE(on_one_line(rows.out).find(why), std::string::npos) << rows.out;
    EXPECT_EQ(rows.out.find("+-"), std::string::npos) << rows.out;
    EXPECT_NE(shell(few + "64" + swept).out.find("+-"), std::string::npos);
  }
}

// The report is long; what to type next stands below it.
TEST(Reports, HowToGoOnComesLast) {
  const Shell shell;
  const Outcome o = shell(
      "$carom escape mushroom --trajectories 1e8 --t-max 200 --quiet -o a.h5 --checkpoint 0.2 "
      ">both 2>&1 & pid=$!; until_saved a.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(o.status, 130);
  const auto lines = lines_of(shell.read("both"));
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("carom escape --resume a.h5"), std::string::npos) << lines.back();
  EXPECT_NE(lines.front().find("ushroom"), std::string::npos) << lines.front();
}

}  // namespace
}  // namespace carom
