// A system as it was written: what certified orbits start from.
#pragma once

#include <memory>
#include <optional>

#include "carom/base/exact_number.hpp"
#include "carom/table/table.hpp"
#include "carom/table/table_spec.hpp"

namespace carom {

/// Where an orbit starts: a point of the plane, or the point of a wall with parameter u.
/// `direction` is that of the velocity, its length is free; or its angle is given.
struct ExactStart {
  ExactPoint position = {};
  ExactPoint direction = {};
  std::optional<ExactNumber> angle = {};
  int wall = -1;
  double u = 0.0;
};

/// One free particle on a table, with the numbers that were written.
struct ExactSystem {
  std::shared_ptr<const TableSpec> spec;
  std::shared_ptr<const Table>
      table;  ///< the same in doubles: names, and the order of walls and holes
  ExactNumber speed{1.0};
  ExactNumber omega;  ///< charge B / mass
  ExactStart start;
};

}  // namespace carom
