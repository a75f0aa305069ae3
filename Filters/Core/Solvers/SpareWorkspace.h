// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>

namespace morph
{
/// Keeps one solve's work vectors for the next: new pages cost up to a tenth of a solve of some
/// thousand rows. Large vectors are freed at once, as a caller may need its peak of memory then.
/// What the vectors hold has no effect. Several threads may use one object.
template <typename Workspace>
class SpareWorkspace
{
public:
  static constexpr std::size_t MostBytes = std::size_t(1) << 28; ///< that are kept

  /// Returns the spare, or makeNew().
  template <typename MakeNew>
  std::unique_ptr<Workspace> take(const MakeNew& makeNew) const
  {
    {
      const std::lock_guard<std::mutex> lock(this->mutex_);
      if (this->spare_)
      {
        return std::move(this->spare_);
      }
    }
    return makeNew();
  }

  /// `bytes`: of its vectors.
  void giveBack(std::unique_ptr<Workspace> workspace, std::size_t bytes) const
  {
    if (bytes <= MostBytes)
    {
      const std::lock_guard<std::mutex> lock(this->mutex_);
      this->spare_ = std::move(workspace);
    }
  }

private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<Workspace> spare_;
};
}
