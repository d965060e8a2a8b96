#include <limits>

#include "carom/table/table.hpp"

namespace carom {

TableMeasure measure(const Table& table) {
  constexpr double pi = 3.141592653589793;
  TableMeasure result;
  double area = table.extent == Extent::lattice ? table.lattice->cell_area() : 0.0;
  for (const Wall& wall : table.walls) {
    area += geometry::area_integral(wall.curve);
    result.perimeter += geometry::length(wall.curve);
  }
  result.area = table.extent == Extent::open_plane ? std::numeric_limits<double>::infinity() : area;
  result.mean_flight = regions_change_speeds(table) ? std::numeric_limits<double>::quiet_NaN()
                                                    : pi * result.area / result.perimeter;
  return result;
}

}  // namespace carom
