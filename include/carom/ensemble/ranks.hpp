// Processes that share an ensemble.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace carom {

/// Messages between the processes of one run, numbered from 0. At any time one thread of a process calls it.
class Ranks {
 public:
  /// What one process has sent.
  struct Message {
    int from = 0;
    std::vector<std::byte> bytes;
  };

  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Messages between two ranks arrive in the order in which they were sent. Up to 4 kB never wait for the receiver.
  virtual void send(int to, const std::vector<std::byte>&) = 0;
  /// A message that has arrived, if there is one.
  virtual std::optional<Message> receive() = 0;
};

}  // namespace carom
