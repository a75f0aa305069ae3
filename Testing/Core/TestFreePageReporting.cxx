// SPDX-License-Identifier: BSD-3-Clause
#include "Support/FreePageReporting.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

using namespace morph;
namespace fs = std::filesystem;

namespace
{
/// A list of devices as the kernel has it.
class FreePageReporting : public testing::Test
{
protected:
  FreePageReporting() { fs::remove_all(this->folder_); }
  ~FreePageReporting() override { fs::remove_all(this->folder_); }

  void add(const std::string& name, const std::string& device, const std::string& features) const
  {
    fs::create_directories(this->folder_ / name);
    std::ofstream(this->folder_ / name / "device") << device << "\n";
    std::ofstream(this->folder_ / name / "features") << features << "\n";
  }
  bool reports() const { return reportsFreePages(this->folder_.string()); }

private:
  const fs::path folder_ = fs::temp_directory_path() / ("morph-virtio-" + std::to_string(getpid()));
};
}

TEST_F(FreePageReporting, IsOffWithoutDevices)
{
  EXPECT_FALSE(this->reports());
}

TEST_F(FreePageReporting, IsFoundAmongOtherDevices)
{
  this->add("virtio0", "0x0002", "0111111100");
  this->add("virtio1", "0x0005", "0110010100");
  EXPECT_TRUE(this->reports());
}

TEST_F(FreePageReporting, IsOffInOtherBalloonsAndDevices)
{
  this->add("virtio0", "0x0005", "0110100100");
  this->add("virtio1", "0x0002", "1111111111");
  this->add("virtio2", "0x0005", "01100");
  this->add("virtio3", "0x0005", "");
  EXPECT_FALSE(this->reports());
}
