// The terms of a query, and what each hands to a lambda:
//
//   term               each()             eachSegment()          meaning
//   T                  T&                 T*  / Lanes<T>         must be there; marked as changed
//   const T            const T&           const T* / Lanes<…>    must be there
//   Maybe<[const] T>   T* or null         as above, or null      may be there
//   With<T>            -                  -                      must be there; for tags
//   Without<T>         -                  -                      must not be there
//   Changed<T>         -                  -                      passes rows (each) or segments in
//                                                                which any Changed<> was written
//                                                                after the query's since()
//   WithDisabled       -                  -                      disabled entities (World::
//                                                                setEnabled) too; else they are
//                                                                skipped
// A component split into lanes is loaded into a T before the call and stored after it.
#pragma once

#include "runtime/ecs/component.h"

#include <cstring>
#include <tuple>

namespace penumbra::ecs {

template <class T>
struct Maybe {};
template <class T>
struct With {};
template <class T>
struct Without {};
template <class T>
struct Changed {};
struct WithDisabled {};

// The columns of one lane-split component in one segment: lane[0][i] is x of row i.
template <class T>
struct Lanes {
    using Element =
        std::conditional_t<std::is_const_v<T>, const Lane<std::remove_const_t<T>>, Lane<T>>;
    std::array<Element*, kLaneCount<std::remove_const_t<T>>> lane{};
    [[nodiscard]] Element* operator[](size_t i) const { return lane[i]; }
};

enum class TermKind { data, with, without, changed, option };

template <class T>
struct TermTraits { // T, const T
    using Component = std::remove_const_t<T>;
    using Access = T;
    static constexpr TermKind kKind = TermKind::data;
    static constexpr bool kOptional = false;
};
template <class T>
struct TermTraits<Maybe<T>> : TermTraits<T> {
    static constexpr bool kOptional = true;
};
template <class T, TermKind kTermKind>
struct FilterTraits {
    using Component = std::remove_const_t<T>;
    using Access = const Component;
    static constexpr TermKind kKind = kTermKind;
    static constexpr bool kOptional = false;
};
template <class T>
struct TermTraits<With<T>> : FilterTraits<T, TermKind::with> {};
template <class T>
struct TermTraits<Without<T>> : FilterTraits<T, TermKind::without> {};
template <class T>
struct TermTraits<Changed<T>> : FilterTraits<T, TermKind::changed> {};
template <>
struct TermTraits<WithDisabled> : FilterTraits<WithDisabled, TermKind::option> {}; // no component

template <class Term>
inline constexpr bool kIsData = TermTraits<Term>::kKind == TermKind::data;
template <class Term>
inline constexpr bool kWrites =
    kIsData<Term> && !std::is_const_v<typename TermTraits<Term>::Access>;

// One argument of an each() lambda: made from the term's column pointers for row i; afterwards
// store() writes a lane-split value back.
template <class Term>
class RowArgument {
public:
    using Traits = TermTraits<Term>;
    using T = typename Traits::Component;
    using Access = typename Traits::Access;
    static constexpr uint32_t kPointers = kLaneCount<T>;
    static constexpr bool kSplit = kPointers > 1;
    using Element = typename Lanes<Access>::Element;

    // columns[kFirst …] are the term's; all null if the component is absent.
    template <size_t kFirst, class Columns>
    void load(const Columns& columns, size_t row)
    {
        Element* first = std::get<kFirst>(columns);
        if (Traits::kOptional && first == nullptr)
            return;
        if constexpr (kSplit) {
            [&]<size_t... kLane>(std::index_sequence<kLane...>)
            {
                (std::memcpy(reinterpret_cast<std::byte*>(&m_value) + kLane * sizeof(Element),
                             std::get<kFirst + kLane>(columns) + row, sizeof(Element)),
                 ...);
            }
            (std::make_index_sequence<kPointers>());
            m_pointer = &m_value;
        } else {
            m_pointer = first + row;
        }
    }

    template <size_t kFirst, class Columns>
    void store([[maybe_unused]] const Columns& columns, [[maybe_unused]] size_t row)
    {
        if constexpr (kSplit && kWrites<Term>) {
            if (Traits::kOptional && m_pointer == nullptr)
                return;
            [&]<size_t... kLane>(std::index_sequence<kLane...>)
            {
                (std::memcpy(std::get<kFirst + kLane>(columns) + row,
                             reinterpret_cast<const std::byte*>(&m_value) + kLane * sizeof(Element),
                             sizeof(Element)),
                 ...);
            }
            (std::make_index_sequence<kPointers>());
        }
    }

    [[nodiscard]] decltype(auto) get() const
    {
        if constexpr (Traits::kOptional)
            return static_cast<Access*>(m_pointer);
        else
            return static_cast<Access&>(*m_pointer);
    }

private:
    struct Nothing {};
    Access* m_pointer = nullptr;
    [[no_unique_address]] std::conditional_t<kSplit, T, Nothing> m_value{};
};

// The columns of a tuple of RowArguments as one list: the lanes of an argument side by side.
template <class Arguments>
struct FlatColumns;
template <class... Arguments>
struct FlatColumns<std::tuple<Arguments...>> {
    struct Place {
        size_t argument, lane;
    };
    static constexpr size_t kCount = (size_t{0} + ... + Arguments::kPointers);
    static constexpr std::array<Place, kCount> kPlaces = [] {
        std::array<Place, kCount> places{};
        size_t at = 0, argument = 0;
        [[maybe_unused]] const auto add = [&](size_t lanes) {
            for (size_t lane = 0; lane < lanes; ++lane)
                places[at++] = {argument, lane};
            ++argument;
        };
        (add(Arguments::kPointers), ...);
        return places;
    }();
    // Of the argument's first lane.
    static constexpr size_t first(size_t argument)
    {
        size_t at = 0;
        while (kPlaces[at].argument != argument)
            ++at;
        return at;
    }
};

} // namespace penumbra::ecs
