// Schedule: the systems of a frame, in phases, in parallel where their declared accesses allow.
//
//   void integrate(SystemContext& context)
//   {
//       context.query<Position, const Velocity>().parallelEach([](Position& p, const Velocity& v)
//       {…});
//   }
//   Schedule schedule(world, {"input", "simulate", "render"});
//   schedule.add<Position, const Velocity>("integrate", "simulate", integrate);
//   schedule.run(); // once per frame
//
// Order: phases run one after the other. Within a phase, a system waits for the systems added
// before it with which it conflicts (one writes what the other reads or writes), and for those that
// its or their SystemOrder puts before it, which goes before the order of adding; the rest may run
// at once on TBB. Structural changes recorded in context.commands() are made at one point, after
// the last phase, in the order of the systems. The world after run() is therefore the
// same, bit for bit, at any number of threads, as long as systems share nothing but components.
#pragma once

#include "runtime/ecs/system_context.h"

#include <functional>
#include <memory>
#include <string>

namespace penumbra::ecs {

// Names of systems of the same phase, added earlier or later. A circle asserts when it closes, a
// name that nobody bears at the next run().
struct SystemOrder {
    std::vector<std::string> before; // this one runs before these
    std::vector<std::string> after;  // this one runs after these
};

class Schedule {
public:
    using System = std::function<void(SystemContext&)>;

    // One schedule per world: Changed<> counts from each system's last run.
    Schedule(World& world, std::vector<std::string> phases);
    ~Schedule();
    Schedule(const Schedule&) = delete;
    Schedule& operator=(const Schedule&) = delete;

    // Ts: what the system touches; const T is read, T is written. Names are unique.
    template <class... Ts>
    void add(std::string name, std::string_view phase, System system, SystemOrder order = {})
    {
        add(std::move(name), phase, Access::of<Ts...>(), std::move(system), std::move(order));
    }
    void add(std::string name, std::string_view phase, const Access& access, System system,
             SystemOrder order = {});

    PlaybackStatistics run();

    struct Timing {
        std::string_view name;
        double medianMs = 0; // of the last kTimingFrames runs
        double lastMs = 0;
        uint64_t lastRows =
            0; // that the queries it made could hand out; Changed<> is not looked at
    };
    [[nodiscard]] std::vector<Timing> timings() const; // in the order of execution on one thread

    // Graphviz: a cluster per phase, an edge per wait, labelled with the components that cause it;
    // dashed if SystemOrder alone does.
    [[nodiscard]] std::string toDot() const;

    static constexpr uint32_t kTimingFrames = 64; // about one second
    // A phase that took less than this, all systems together, runs inline next time: waking another
    // thread costs 5 to 20 µs. A guess from times never changes results, only where they are made.
    static constexpr double kInlineMs = 0.03;

private:
    struct Node;
    struct Phase {
        std::string name;
        std::vector<uint32_t> systems; // in the order of one thread
    };

    [[nodiscard]] bool isOrdered(uint32_t first, uint32_t second) const; // by a SystemOrder
    void sortPhase(Phase& phase) const;
    void connect(Phase& phase);
    void checkNames() const;

    void runPhase(const Phase& phase, Stamp base);
    void runSystem(Node& node, Stamp base);

    World& m_world;
    std::vector<Phase> m_phases;
    std::vector<std::unique_ptr<Node>> m_systems; // in the order added
    bool m_namesChecked = false;
};

} // namespace penumbra::ecs
