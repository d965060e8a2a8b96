#include "certify/wall/ball_table.hpp"

#include "certify/wall/table_builder.hpp"

namespace carom::certify {

BallTable ball_table(const TableSpec& spec) { return table_of<Ball>(spec); }

}  // namespace carom::certify
