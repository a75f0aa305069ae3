// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace morph
{
/// Whether this virtual machine gives free memory back to its host, in pieces of 2 MiB. `devices`:
/// the kernel's list of its virtio devices. Returns false where nothing can be read. Source:
/// Virtual I/O Device (VIRTIO) 1.2, section 5.5, feature VIRTIO_BALLOON_F_PAGE_REPORTING.
bool reportsFreePages(const std::string& devices = "/sys/bus/virtio/devices") noexcept;
}
