// Orbits run back to where they came from.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "certify/number/exact_value.hpp"
#include "certify/systems.hpp"

namespace carom::tests {

/// An orbit of about that many hits ends after `time`; from there it is run back in the system
/// `reversed`, and comes to its start. 200 digits of the end are the start's to at least 60, if
/// they lose less than 4.6 bits a hit.
inline void expect_to_run_back(const ExactSystem& system, ExactSystem reversed,
                               const std::string& time, int hits) {
  CertifiedTask task = task_of(0, 200);
  task.t_max = exactly(time);
  CertifiedOrbit there(system, task);
  const CertifiedEnd end = there.finish();
  ASSERT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_NEAR(static_cast<double>(end.collisions), hits, 2);
  reversed.start.position = {exactly(end.x.text(200)), exactly(end.y.text(200))};
  reversed.start.direction = {exactly("-(" + end.vx.text(200) + ")"),
                              exactly("-(" + end.vy.text(200) + ")")};
  task.digits = 60;
  CertifiedOrbit back(reversed, task);
  const CertifiedEnd start = back.finish();
  EXPECT_EQ(start.collisions, end.collisions);
  const certify::Precision precision(800);
  EXPECT_EQ(start.x.text(60), certify::value_of(system.start.position.x).decimals(60));
  EXPECT_EQ(start.y.text(60), certify::value_of(system.start.position.y).decimals(60));
}

}  // namespace carom::tests
