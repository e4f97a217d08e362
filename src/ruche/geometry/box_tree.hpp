#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

namespace ruche {

/// A box along the axes, empty until something is added.
template <class Scalar>
struct AxisBox {
    using Point = std::array<Scalar, 3>;
    static constexpr Scalar most = std::numeric_limits<Scalar>::max();

    Point low = {most, most, most};
    Point high = {-most, -most, -most};

    bool empty() const { return low[0] > high[0]; }
    void add(const Point& p) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    void add(const AxisBox& box) {
        add(box.low);
        add(box.high);
    }
    /// From a point to the nearest of the box, squared.
    Scalar squared_distance(const Point& p) const {
        Scalar sum = 0;
        for (int k = 0; k < 3; ++k) {
            const Scalar beyond = std::max({low[k] - p[k], p[k] - high[k], Scalar{0}});
            sum += beyond * beyond;
        }
        return sum;
    }
    bool meets(const AxisBox& other) const {
        return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
               other.low[1] <= high[1] && low[2] <= other.high[2] && other.low[2] <= high[2];
    }
};

/// A binary tree over boxes, split at the median of the longest side; its leaves are runs of `order`. Empty
/// boxes are left out.
template <class Scalar>
class BoxTree {
  public:
    using Box = AxisBox<Scalar>;

    explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        std::erase_if(order_, [&](int t) { return boxes_[t].empty(); });
        if (!order_.empty()) build(0, static_cast<int>(order_.size()));
    }

    /// Calls visit(u) for every box u > t that meets box t.
    template <class Visit>
    void later_neighbours(int t, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::array<int, 64> stack;  // the tree is balanced: depth below 32
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (!node.box.meets(boxes_[t])) continue;
            if (node.right > 0) {
                stack[top++] = node.right;
                stack[top++] = static_cast<int>(&node - nodes_.data()) + 1;
                continue;
            }
            for (int i = node.begin; i < node.end; ++i) {
                const int u = order_[i];
                if (u > t && boxes_[u].meets(boxes_[t])) visit(u);
            }
        }
    }

    /// The item whose `squared_distance(t)` from p is the smallest, asked only of those whose boxes are near
    /// enough; -1 when none is nearer than the square root of `within`.
    template <class SquaredDistance>
    int nearest(const typename Box::Point& p, Scalar within, const SquaredDistance& squared_distance) const {
        int best = -1;
        if (nodes_.empty()) return best;
        std::array<int, 64> stack;
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const int self = stack[--top];
            const Node& node = nodes_[self];
            if (node.box.squared_distance(p) >= within) continue;
            if (node.right > 0) {
                const bool right_first =
                    nodes_[node.right].box.squared_distance(p) < nodes_[self + 1].box.squared_distance(p);
                stack[top++] = right_first ? self + 1 : node.right;
                stack[top++] = right_first ? node.right : self + 1;
                continue;
            }
            for (int i = node.begin; i < node.end; ++i) {
                const Scalar distance = squared_distance(order_[i]);
                if (distance >= within) continue;
                within = distance;
                best = order_[i];
            }
        }
        return best;
    }

    /// Neighbours in this order are neighbours in space.
    const std::vector<int>& order() const { return order_; }

  private:
    static constexpr int leaf_size = 4;

    struct Node {
        Box box;
        int right = 0;  ///< its left child follows it; 0 for a leaf
        int begin = 0;
        int end = 0;
    };

    void build(int begin, int end) {
        const int self = static_cast<int>(nodes_.size());
        Box box;
        for (int i = begin; i < end; ++i) box.add(boxes_[order_[i]]);
        nodes_.push_back({box, 0, begin, end});
        if (end - begin <= leaf_size) return;
        int axis = 0;
        for (int k = 1; k < 3; ++k) {
            if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
        }
        const auto centre = [&](int t) { return boxes_[t].low[axis] + boxes_[t].high[axis]; };
        const int middle = (begin + end) / 2;
        std::nth_element(
            order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
            [&](int s, int t) { return centre(s) != centre(t) ? centre(s) < centre(t) : s < t; });
        build(begin, middle);
        nodes_[self].right = static_cast<int>(nodes_.size());
        build(middle, end);
    }

    std::vector<Box> boxes_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace ruche
