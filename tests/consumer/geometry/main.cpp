#include <carom/geometry/region.hpp>
#include <cstdio>

using namespace carom::geometry;

// A disc inside an ellipse is a sound region; a disc that crosses it is not.
int main() {
  const Loop ellipse{{"ellipse", Ellipse{.centre = {0, 0}, .axis = {2, 0}, .ratio = 0.5}}};
  const Loop inside{
      {"disc", Circle{.centre = {0.5, 0}, .radius = 0.25, .counterclockwise = false}}};
  const Loop across{{"disc", Circle{.centre = {2, 0}, .radius = 0.25, .counterclockwise = false}}};
  const auto sound = check_region({ellipse, inside}, RegionKind::bounded);
  const auto faults = check_region({ellipse, across}, RegionKind::bounded);
  for (const RegionFault& fault : faults) std::printf("%s\n", fault.sentence.c_str());
  std::printf("area %.12f\n", area({ellipse, inside}));
  return sound.empty() && !faults.empty() ? 0 : 1;
}
