// carom run --precision certified as a user sees it.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdlib>

#include "archive_contents.hpp"
#include "cli/program.hpp"

namespace carom {
namespace {

std::string text_of(hid_t file, const char* name) {
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const std::string text = read_all(dataset);
  H5Dclose(dataset);
  return text.c_str();
}

TEST(Certified, EscapesThroughAHole) {
  const Shell shell;
  const Outcome json = shell("$carom run circle --precision certified --digits 40 --json");
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(json_value(json.out, "status"), "\"escaped\"");
  EXPECT_EQ(json_value(json.out, "hole"), "\"hole_1\"");
  // The first 15 digits of the escape in doubles.
  const std::string t = json_value(json.out, "t"),
                    doubles = json_value(shell("$carom run circle --json").out, "t");
  EXPECT_NEAR(std::strtod(t.c_str() + 1, nullptr), std::strtod(doubles.c_str(), nullptr), 1e-12);
  EXPECT_EQ(t.size() - t.find('.') - 2, 40u);
}

// Also while it looks ahead, and where more bits are needed than there may be.
TEST(Certified, EndsWhenAsked) {
  const Shell shell;
  const Outcome json = shell(
      "$carom run ellipse-magnetic --set field.B=0 --collisions 1e9 --t-max 1e300 --precision "
      "certified --json & pid=$!; "
      "until_listening; sleep 1; kill -INT $pid; wait $pid");
  EXPECT_EQ(json_value(json.out, "status"), "\"interrupted\"") << json.err;
  EXPECT_EQ(json_value(json.out, "collisions"), "0");
  const Outcome far = shell(
      "$carom run stadium --set table.hole=[] --collisions 1e8 --t-max 1e300 --precision "
      "certified");
  EXPECT_EQ(far.status, 0) << far.err;
  EXPECT_NE(far.out.find("the requested digits need 1221"), std::string::npos) << far.out;
}

TEST(Certified, LeavesAnArchive) {
  const Shell shell;
  const std::string run =
      "$carom run stadium --set table.hole=[] --collisions 300 --t-max 1e6 --precision certified "
      "--digits 30 --json -o orbit.h5";
  const Outcome json = shell(run);
  ASSERT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(shell(run).status, 1);  // it exists
  EXPECT_EQ(shell(run + " --force").status, 0);
  EXPECT_EQ(shell.files(), std::vector<std::string>{"orbit.h5"});
  const hid_t file = H5Fopen((shell.folder() + "/orbit.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  for (const char* key : {"t", "x", "y", "vx", "vy"})
    EXPECT_EQ("\"" + text_of(file, (std::string("state/") + key + "_decimals").c_str()) + "\"",
              json_value(json.out, key));
  // The last row of the hits is the end, in both forms.
  const hid_t decimals = H5Dopen2(file, "collisions/y_decimals", H5P_DEFAULT),
              type = H5Dget_type(decimals);
  const std::size_t length = H5Tget_size(type);
  std::string rows(300 * length, '\0');
  ASSERT_GE(H5Dread(decimals, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
  const hid_t numbers = H5Dopen2(file, "collisions/y", H5P_DEFAULT);
  std::vector<double> y(300);
  ASSERT_GE(H5Dread(numbers, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, y.data()), 0);
  for (std::size_t i = 0; i < y.size(); ++i)
    ASSERT_EQ(std::strtod(rows.substr(i * length, length).c_str(), nullptr), y[i]) << i;
  EXPECT_EQ("\"" + std::string(rows.substr(299 * length, length).c_str()) + "\"",
            json_value(json.out, "y"));
  H5Dclose(numbers);
  H5Tclose(type);
  H5Dclose(decimals);
  H5Fclose(file);
}

// Columns are as wide as the longest number, which comes when it comes.
TEST(Certified, LeavesAnArchiveOfLargeNumbers) {
  const Shell shell;
  const Outcome json = shell(
      "$carom run stadium --set table.hole=[] --set 'table.half_length=\"10^29\"' --set "
      "'table.radius=\"10^29\"' "
      "--position 1/10,1/5 --velocity 3,4 --set particles.speed=1 --collisions 100 --t-max 1e300 "
      "--precision certified --digits 20 --json -o orbit.h5");
  ASSERT_EQ(json.status, 0) << json.err;
  const hid_t file = H5Fopen((shell.folder() + "/orbit.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  for (const char* key : {"t", "x", "vx"}) {
    const hid_t decimals =
        H5Dopen2(file, (std::string("collisions/") + key + "_decimals").c_str(), H5P_DEFAULT);
    const hid_t type = H5Dget_type(decimals);
    const std::size_t length = H5Tget_size(type);
    std::string rows(100 * length, '\0');
    ASSERT_GE(H5Dread(decimals, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
    const hid_t numbers = H5Dopen2(file, (std::string("collisions/") + key).c_str(), H5P_DEFAULT);
    std::vector<double> values(100);
    ASSERT_GE(H5Dread(numbers, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    for (std::size_t i = 0; i < values.size(); ++i)
      ASSERT_EQ(std::strtod(rows.substr(i * length, length).c_str(), nullptr), values[i])
          << key << i;
    EXPECT_EQ("\"" + std::string(rows.substr(99 * length, length).c_str()) + "\"",
              json_value(json.out, key));
    H5Dclose(numbers);
    H5Tclose(type);
    H5Dclose(decimals);
  }
  H5Fclose(file);
}

// Decided by the numbers as written, with the reason.
TEST(Certified, StartsInsideTheTable) {
  const Shell shell;
  const std::string run =
      "$carom run circle --precision certified --digits 20 --collisions 1 --velocity=-1,-0.2 "
      "--position ";
  const Outcome outside = shell(run + "'8/17,15/17+1/10^20'");
  expect_refused(outside, "command line: --position: ");
  EXPECT_NE(shell(run + "8/17,15/17").err.find("'circle'"), std::string::npos);
  EXPECT_EQ(shell(run + "'8/17,15/17-1/10^20'").status, 0);
  const Outcome fast =
      shell("$carom run circle --precision certified --position 0,0 --velocity '1,10^200'");
  EXPECT_EQ(fast.status, 1);
  EXPECT_EQ(fast.err.find("--position"), std::string::npos) << fast.err;
}

TEST(Certified, RefusesOtherPrecisions) {
  const Shell shell;
  for (const char* bad : {"52", "256", "1e9", "53.5", "100 -o x.h5"}) {
    const Outcome refused = shell(std::string("$carom run siam-photon --json --precision ") + bad);
    expect_refused(refused, "command line: --precision: ");
  }
}

TEST(Certified, SaysThatAVelocityWasADirection) {
  const Shell shell;
  const std::string run =
      "$carom run stadium --set table.hole=[] --set particles.speed=1 --position 0.1,0.2 "
      "--collisions 5 "
      "--json "
      "--precision certified --velocity ";
  EXPECT_EQ(json_value(shell(run + "3,4").out, "rescaled"), "true");
  EXPECT_EQ(json_value(shell(run + "0.6,0.8").out, "rescaled"), "false");
  EXPECT_EQ(json_value(shell(run + "1/3,'sqrt(8)/3'").out, "rescaled"), "false");
  EXPECT_EQ(json_value(shell(run + "3,4").out, "x"), json_value(shell(run + "0.6,0.8").out, "x"));
  for (const char* digits : {"0", "-1", "1e9", "many"})
    EXPECT_EQ(shell(run + "3,4 --digits " + digits).status, 1) << digits;
  for (const char* digits : {"1000001", "1000000000"})
    expect_refused(shell(run + "3,4 --digits " + digits), "command line: --digits: ");
  EXPECT_EQ(shell(run + "'sqrt(-1)',4").status, 1);
}

TEST(Certified, SaysWhereANumberIsNone) {
  const Shell shell;
  const Outcome refused = shell(
      "printf '[table]\\nshape = \"circle\"\\nradius = \"sqr(2)\"\\n' > bad.toml; $carom run "
      "./bad.toml "
      "--precision certified");
  expect_refused(refused, "./bad.toml, line 3, column 10: table.radius: ");
  expect_refused(shell("$carom run circle --position 0.1,0.x --velocity 1,0 --precision certified"),
                 "command line: --position: ");
}

TEST(Certified, NamesExactCorners) {
  const Shell shell;
  const Outcome text = shell(
      "$carom run magnetic-square --set field.B=0 --set table.hole=[] --position 1/2,1/4 "
      "--velocity 2,3 "
      "--collisions 10 --precision certified");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(
      text.out.find("exact tie     event 1: exactly into the corner between 'right' and 'top'"),
      std::string::npos)
      << text.out;
}

}  // namespace
}  // namespace carom
