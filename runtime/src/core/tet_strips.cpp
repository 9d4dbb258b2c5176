// SPDX-License-Identifier: Apache-2.0
#include "core/tet_strips.h"

#include <algorithm>
#include <numeric>

namespace knead::core {
namespace {

static_assert(kTetsInStrip == 3, "the order of a strip's nodes and the repairs are made for three");

constexpr std::uint32_t kNone = TetStrip::kNone;
/// Tetrahedra that a repair looks at before it gives up; where the mesh allows it at all, it takes a few.
constexpr std::size_t kMostMoves = 300;

bool has(const Element& element, std::uint32_t node) {
    return std::find(element.nodes.begin(), element.nodes.end(), node) != element.nodes.end();
}

bool share_one_face(const Element& a, const Element& b) {
    return std::count_if(a.nodes.begin(), a.nodes.end(), [&](std::uint32_t node) { return has(b, node); }) ==
           3;
}

/// For every tetrahedron those beyond its faces; kNone behind the last one.
class FaceNeighbours {
  public:
    explicit FaceNeighbours(const std::vector<Element>& elements)
        : of_(elements.size(), {kNone, kNone, kNone, kNone}) {
        std::vector<std::uint32_t> begin;
        const std::vector<Face> faces = sorted_faces(elements, begin);
        for (std::size_t node = 0; node + 1 < begin.size(); ++node) {
            for (std::size_t k = begin[node] + 1; k < begin[node + 1]; ++k) {
                if (faces[k].others != faces[k - 1].others) continue;
                const std::uint32_t a = faces[k - 1].element, b = faces[k].element;
                ++k;  // a face has two sides, even where a careless mesh has more
                if (!share_one_face(elements[a], elements[b])) continue;
                *std::find(of_[a].begin(), of_[a].end(), kNone) = b;
                *std::find(of_[b].begin(), of_[b].end(), kNone) = a;
            }
        }
    }
    template <class Use>
    void for_each(std::uint32_t element, Use&& use) const {
        for (const std::uint32_t other : of_[element]) {
            if (other != kNone) use(other);
        }
    }

  private:
    struct Face {
        std::uint64_t others;  ///< its second and third node, ascending
        std::uint32_t element;
    };
    /// By nodes, ascending, then by tetrahedron. @param begin out: [nodes + 1] where faces with that first
    /// node begin
    static std::vector<Face> sorted_faces(const std::vector<Element>& elements,
                                          std::vector<std::uint32_t>& begin) {
        std::vector<std::array<std::uint32_t, 4>> sorted(elements.size());
        std::uint32_t nodes = 0;
        for (std::size_t e = 0; e < elements.size(); ++e) {
            sorted[e] = elements[e].nodes;
            std::sort(sorted[e].begin(), sorted[e].end());
            nodes = std::max(nodes, sorted[e][3] + 1);
        }
        // Three of an element's faces have its first node as their first, one its second.
        begin.assign(std::size_t{nodes} + 1, 0);
        for (const auto& [a, b, c, d] : sorted) {
            begin[a + 1] += 3;
            ++begin[b + 1];
        }
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
        std::vector<Face> faces(4 * elements.size());
        const auto pack = [](std::uint32_t low, std::uint32_t high) {
            return std::uint64_t{low} << 32U | high;
        };
        for (std::uint32_t e = 0; e < elements.size(); ++e) {
            const auto [a, b, c, d] = sorted[e];
            faces[next[a]++] = {pack(b, c), e};
            faces[next[a]++] = {pack(b, d), e};
            faces[next[a]++] = {pack(c, d), e};
            faces[next[b]++] = {pack(c, d), e};
        }
        for (std::size_t node = 0; node < nodes; ++node) {
            std::sort(faces.begin() + begin[node], faces.begin() + begin[node + 1],
                      [](const Face& a, const Face& b) {
                          return a.others != b.others ? a.others < b.others : a.element < b.element;
                      });
        }
        return faces;
    }

    std::vector<std::array<std::uint32_t, 4>> of_;
};

/// Tetrahedra, each of which shares a face with the next.
struct Path {
    std::array<std::uint32_t, kTetsInStrip> elements{kNone, kNone, kNone};
    std::uint32_t size = 0;

    [[nodiscard]] bool full() const { return size == kTetsInStrip; }
    [[nodiscard]] std::uint32_t front() const { return elements[0]; }
    [[nodiscard]] std::uint32_t back() const { return elements[size - 1]; }
    void push_back(std::uint32_t element) { elements[size++] = element; }
    void push_front(std::uint32_t element) {
        std::copy_backward(elements.begin(), elements.begin() + size, elements.begin() + size + 1);
        elements[0] = element;
        ++size;
    }
};

class PathCover {
  public:
    explicit PathCover(const std::vector<Element>& elements)
        : neighbours_(elements), path_of_(elements.size(), kNone) {
        take_greedily();
        repair();
    }
    /// In the order of their first tetrahedron in the list.
    [[nodiscard]] std::vector<Path> paths() const {
        std::vector<Path> result;
        std::vector<std::uint8_t> taken(paths_.size(), 0);
        for (const std::uint32_t path : path_of_) {
            if (taken[path] == 0) result.push_back(paths_[path]);
            taken[path] = 1;
        }
        return result;
    }

  private:
    [[nodiscard]] std::uint32_t count_free_neighbours(std::uint32_t element) const {
        std::uint32_t count = 0;
        neighbours_.for_each(element,
                             [&](std::uint32_t other) { count += path_of_[other] == kNone ? 1 : 0; });
        return count;
    }

    /// The free neighbour that itself has the fewest; kNone if there is none.
    [[nodiscard]] std::uint32_t loneliest_neighbour(std::uint32_t element) const {
        std::uint32_t best = kNone, fewest = 5;
        neighbours_.for_each(element, [&](std::uint32_t other) {
            if (path_of_[other] != kNone) return;
            const std::uint32_t count = count_free_neighbours(other);
            if (count >= fewest) return;
            fewest = count;
            best = other;
        });
        return best;
    }

    Path take_path(std::uint32_t first) {
        const auto number = static_cast<std::uint32_t>(paths_.size());
        Path path;
        for (std::uint32_t e = first; e != kNone;
             e = path.full() ? kNone : loneliest_neighbour(path.back())) {
            path.push_back(e);
            path_of_[e] = number;
        }
        // The other way, if this one was a dead end.
        while (!path.full()) {
            const std::uint32_t e = loneliest_neighbour(path.front());
            if (e == kNone) break;
            path.push_front(e);
            path_of_[e] = number;
        }
        return path;
    }

    void take_greedily() {
        std::array<std::vector<std::uint32_t>, 5> waiting;  // by free neighbours; entries may be outdated
        const auto wait = [&](std::uint32_t e) { waiting[count_free_neighbours(e)].push_back(e); };
        for (auto e = static_cast<std::uint32_t>(path_of_.size()); e-- > 0;)
            wait(e);
        for (std::size_t count = 0; count < waiting.size();) {
            if (waiting[count].empty()) {
                ++count;
                continue;
            }
            const std::uint32_t first = waiting[count].back();
            waiting[count].pop_back();
            if (path_of_[first] != kNone || count_free_neighbours(first) != count) continue;
            paths_.push_back(take_path(first));
            const Path& path = paths_.back();
            for (std::uint32_t k = 0; k < path.size; ++k) {
                neighbours_.for_each(path.elements[k], [&](std::uint32_t other) {
                    if (path_of_[other] == kNone) wait(other);
                });
            }
            count = 0;
        }
    }

    /// Dissolves paths that are not full, as far as their tetrahedra find a place elsewhere.
    void repair() {
        for (std::uint32_t size = 1; size < kTetsInStrip; ++size) {
            for (std::uint32_t p = 0; p < paths_.size(); ++p) {
                while (paths_[p].size > 0 && paths_[p].size <= size) {
                    if (!place_elsewhere(p)) break;
                }
            }
        }
    }

    /// A path that takes in another tetrahedron and frees `freed` in turn, because of the move `cause`.
    struct Move {
        std::uint32_t freed, cause, number;
        Path path;
    };

    /// Finds room for the last tetrahedron of a path: breadth first through the full paths, each of which may
    /// swap an end, to one that is not full.
    bool place_elsewhere(std::uint32_t origin) {
        Move first{paths_[origin].back(), kNone, origin, paths_[origin]};
        first.path.elements[--first.path.size] = kNone;
        std::vector<Move> moves{first};
        for (std::uint32_t m = 0; m < moves.size() && moves.size() < kMostMoves; ++m) {
            const std::uint32_t e = moves[m].freed;
            bool placed = false;
            neighbours_.for_each(e, [&](std::uint32_t other) {
                const std::uint32_t number = path_of_[other];
                const auto same_path = [&](const Move& move) { return move.number == number; };
                if (placed || std::any_of(moves.begin(), moves.end(), same_path)) return;
                if (paths_[number].full())
                    add_swaps(e, other, m, moves);
                else
                    placed = lengthen(e, other);
            });
            if (!placed) continue;
            for (; m != kNone; m = moves[m].cause)
                set(moves[m].number, moves[m].path);
            return true;
        }
        return false;
    }

    /// The ways in which the path of `other` takes in e and frees one of its ends.
    void add_swaps(std::uint32_t e, std::uint32_t other, std::uint32_t cause,
                   std::vector<Move>& moves) const {
        const std::uint32_t number = path_of_[other];
        const auto [a, b, c] = paths_[number].elements;
        if (other == a) moves.push_back({c, cause, number, {{e, a, b}, 3}});
        if (other == c) moves.push_back({a, cause, number, {{b, c, e}, 3}});
        if (other != b) return;
        moves.push_back({a, cause, number, {{e, b, c}, 3}});
        moves.push_back({c, cause, number, {{a, b, e}, 3}});
    }

    bool lengthen(std::uint32_t e, std::uint32_t other) {
        Path path = paths_[path_of_[other]];
        if (other == path.back())
            path.push_back(e);
        else
            path.push_front(e);
        set(path_of_[other], path);
        return true;
    }

    void set(std::uint32_t number, const Path& path) {
        paths_[number] = path;
        for (std::uint32_t k = 0; k < path.size; ++k)
            path_of_[path.elements[k]] = number;
    }

    FaceNeighbours neighbours_;
    std::vector<std::uint32_t> path_of_;  ///< [elements]
    std::vector<Path> paths_;             ///< empty ones were dissolved
};

/// The node of `a` that `b` has not; they share a face.
std::uint32_t node_without(const Element& a, const Element& b) {
    return *std::find_if_not(a.nodes.begin(), a.nodes.end(),
                             [&](std::uint32_t node) { return has(b, node); });
}

TetStrip strip_of(const std::vector<Element>& elements, const Path& path) {
    TetStrip strip;
    strip.elements = path.elements;
    const Element& first = elements[path.elements[0]];
    if (path.size == 1) {
        std::copy(first.nodes.begin(), first.nodes.end(), strip.nodes.begin());
        return strip;
    }
    const Element& second = elements[path.elements[1]];
    // Nodes 0 and 3 are in all three. Of the second tetrahedron, 2 is not in the third and 4 not in the
    // first.
    strip.nodes[1] = node_without(first, second);
    strip.nodes[4] = node_without(second, first);
    if (path.size == 3) {
        const Element& third = elements[path.elements[2]];
        strip.nodes[2] = node_without(second, third);
        strip.nodes[5] = node_without(third, second);
    }
    for (const std::uint32_t node : second.nodes) {
        if (node == strip.nodes[4] || node == strip.nodes[2]) continue;
        for (const std::size_t k : {0, 3, 2}) {
            if (strip.nodes[k] != kNone) continue;
            strip.nodes[k] = node;
            break;
        }
    }
    return strip;
}

}  // namespace

std::vector<TetStrip> make_tet_strips(const std::vector<Element>& elements) {
    std::vector<TetStrip> strips;
    for (const Path& path : PathCover(elements).paths())
        strips.push_back(strip_of(elements, path));
    return strips;
}

}  // namespace knead::core
