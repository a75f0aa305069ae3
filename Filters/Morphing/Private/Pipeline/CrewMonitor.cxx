// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/CrewMonitor.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace morph::filters
{
/// The caller and the threads that help it.
class CrewMonitor::Crew
{
public:
  explicit Crew(int helpers)
  {
    for (int i = 0; i < helpers; ++i)
    {
      this->Helpers.emplace_back([this] { this->Help(); });
    }
  }

  ~Crew()
  {
    this->Stop = true;
    this->Announce();
    for (std::thread& helper : this->Helpers)
    {
      helper.join();
    }
  }

  void Run(morph::Index n, morph::Index length,
    const std::function<void(morph::Index first, morph::Index last)>& body)
  {
    this->Count = n;
    this->Length = length;
    this->Body = &body;
    this->Thrown = nullptr;
    this->Next = 0;
    this->Busy = static_cast<int>(this->Helpers.size());
    this->Announce();
    this->Work();
    // The helpers end within a range of each other.
    for (int spins = 0; this->Busy.load(std::memory_order_acquire) > 0; ++spins)
    {
      if (spins > Patience)
      {
        std::this_thread::yield();
      }
    }
    if (this->Thrown)
    {
      std::rethrow_exception(this->Thrown);
    }
  }

private:
  // Some 20 microseconds: longer than the gap between two loops of a solver, and too short to waste
  // a core.
  static constexpr int Patience = 20000;

  void Announce()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Job.fetch_add(1, std::memory_order_release);
    }
    this->Wake.notify_all();
  }

  void Help()
  {
    for (std::uint64_t done = 0;; ++done)
    {
      int spins = 0;
      while (this->Job.load(std::memory_order_acquire) == done && spins < Patience)
      {
        ++spins;
      }
      if (spins == Patience)
      {
        std::unique_lock<std::mutex> lock(this->Mutex);
        this->Wake.wait(lock, [&] { return this->Job.load(std::memory_order_acquire) != done; });
      }
      if (this->Stop)
      {
        return;
      }
      this->Work();
      this->Busy.fetch_sub(1, std::memory_order_release);
    }
  }

  void Work()
  {
    try
    {
      for (morph::Index first = this->Next.fetch_add(this->Length); first < this->Count;
           first = this->Next.fetch_add(this->Length))
      {
        (*this->Body)(first, std::min(this->Count, first + this->Length));
      }
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      if (!this->Thrown)
      {
        this->Thrown = std::current_exception();
      }
    }
  }

  std::vector<std::thread> Helpers;
  std::mutex Mutex;
  std::condition_variable Wake;
  std::atomic<std::uint64_t> Job{ 0 }; ///< how many have been announced
  std::atomic<bool> Stop{ false };
  std::atomic<int> Busy{ 0 }; ///< helpers that have not finished the current job

  // The current job; written before it is announced.
  morph::Index Count = 0;
  morph::Index Length = 1;
  const std::function<void(morph::Index, morph::Index)>* Body = nullptr;
  std::atomic<morph::Index> Next{ 0 };
  std::exception_ptr Thrown;
};

CrewMonitor::CrewMonitor(vtkAlgorithm* algorithm, int threads)
  : Monitor(algorithm, threads)
{
}

CrewMonitor::~CrewMonitor() = default;

void CrewMonitor::share(morph::Index n, morph::Index grain,
  const std::function<void(morph::Index first, morph::Index last)>& body)
{
  if (n <= grain || !IsSequential())
  {
    this->Monitor::share(n, grain, body);
    return;
  }
  if (!this->Members)
  {
    this->Members = std::make_unique<Crew>(this->threads() - 1);
  }
  this->Members->Run(n, this->RangeLength(n, grain), body);
}
}
