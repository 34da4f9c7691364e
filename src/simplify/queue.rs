//! The queue of edges, cheapest first.

use crate::mesh::adjacency::NONE;

/// Children of a heap node. Four halve the depth against two, and their costs share a cache line.
const ARITY: usize = 4;

/// An edge and what it is sorted by.
#[derive(Debug, Clone, Copy)]
pub struct Rated {
    /// The edge.
    pub edge: u32,
    /// Its vertices; smaller, then larger are the last criteria.
    pub ends: [u32; 2],
    /// Third criterion: its squared length, rounded so that lengths equal but for rounding are equal.
    pub length_squared: f32,
    /// First and second criterion; `None` for an edge that may not collapse and stays out of the queue.
    pub costs: Option<[f64; 2]>,
}

/// An indexed heap of edges by (cost, second cost, length, smaller vertex, larger vertex), all ascending.
///
/// The key of an edge changes only inside [`EdgeQueue::place`], so that the heap stays in order between any two calls.
#[derive(Debug)]
pub struct EdgeQueue {
    costs: Vec<f64>,
    items: Vec<u32>,
    /// For each edge its node in the heap, [`NONE`] for an edge outside.
    nodes: Vec<u32>,
    ends: Vec<[u32; 2]>,
    lengths_squared: Vec<f32>,
    second_costs: Vec<f64>,
}

impl EdgeQueue {
    /// A queue of the edges between these ends, in linear time. Second costs are stored only if `has_second_cost`.
    pub fn new(ends: Vec<[u32; 2]>, has_second_cost: bool, mut rate: impl FnMut(u32, [u32; 2]) -> Rated) -> Self {
        let count = ends.len();
        let mut queue = Self {
            costs: Vec::with_capacity(count),
            items: Vec::with_capacity(count),
            nodes: vec![NONE; count],
            ends,
            lengths_squared: vec![0.0; count],
            second_costs: vec![0.0; if has_second_cost { count } else { 0 }],
        };
        for edge in 0..count {
            let rated = rate(edge as u32, queue.ends[edge]);
            if let Some(cost) = queue.record(&rated) {
                queue.nodes[edge] = queue.append(cost, rated.edge) as u32;
            }
        }
        for node in (0..queue.items.len().div_ceil(ARITY)).rev() {
            queue.sift_down(node);
        }
        queue
    }

    /// The two vertices of an edge.
    pub fn ends(&self, edge: u32) -> [u32; 2] {
        self.ends[edge as usize]
    }

    /// Whether the edge waits in the queue.
    pub fn contains(&self, edge: u32) -> bool {
        self.nodes[edge as usize] != NONE
    }

    /// Takes the first edge out.
    pub fn pop(&mut self) -> Option<u32> {
        let &first = self.items.first()?;
        self.remove(first);
        Some(first)
    }

    /// Takes an edge out, if it is there.
    pub fn remove(&mut self, edge: u32) {
        let node = std::mem::replace(&mut self.nodes[edge as usize], NONE) as usize;
        if node >= self.items.len() {
            return;
        }
        let (cost, item) = (self.costs.pop(), self.items.pop());
        if let (Some(cost), Some(item)) = (cost, item)
            && item != edge
        {
            self.put(node, cost, item);
            self.restore(node);
        }
    }

    /// Puts an edge where its new costs belong, whether or not it was in the queue.
    pub fn place(&mut self, rated: &Rated) {
        let edge = rated.edge;
        let Some(cost) = self.record(rated) else {
            // Where it lies in the queue does not matter for taking it out, as the last entry fills its node.
            self.remove(edge);
            return;
        };
        let mut node = self.nodes[edge as usize] as usize;
        if node >= self.items.len() {
            node = self.append(cost, edge);
        }
        self.put(node, cost, edge);
        self.restore(node);
    }

    /// Takes over all but the first cost, which it returns.
    fn record(&mut self, rated: &Rated) -> Option<f64> {
        let edge = rated.edge as usize;
        self.ends[edge] = rated.ends;
        self.lengths_squared[edge] = rated.length_squared;
        let [cost, second_cost] = rated.costs?;
        self.second_costs.get_mut(edge).into_iter().for_each(|second| *second = second_cost);
        Some(cost)
    }

    fn append(&mut self, cost: f64, item: u32) -> usize {
        self.costs.push(cost);
        self.items.push(item);
        self.items.len() - 1
    }

    fn restore(&mut self, node: usize) {
        if !self.sift_up(node) {
            self.sift_down(node);
        }
    }

    fn put(&mut self, node: usize, cost: f64, item: u32) {
        self.costs[node] = cost;
        self.items[node] = item;
        self.nodes[item as usize] = node as u32;
    }

    /// Whether it moved.
    fn sift_up(&mut self, start: usize) -> bool {
        let (cost, item) = (self.costs[start], self.items[start]);
        let mut node = start;
        while node > 0 {
            let parent = (node - 1) / ARITY;
            if !self.precedes((cost, item), (self.costs[parent], self.items[parent])) {
                break;
            }
            self.put(node, self.costs[parent], self.items[parent]);
            node = parent;
        }
        if node != start {
            self.put(node, cost, item);
        }
        node != start
    }

    fn sift_down(&mut self, start: usize) {
        let (cost, item) = (self.costs[start], self.items[start]);
        let mut node = start;
        while let Some(child) = self.first_child(node) {
            let (child_cost, child_item) = (self.costs[child], self.items[child]);
            if !self.precedes((child_cost, child_item), (cost, item)) {
                break;
            }
            self.put(node, child_cost, child_item);
            node = child;
        }
        if node != start {
            self.put(node, cost, item);
        }
    }

    /// The child of `node` that comes first.
    fn first_child(&self, node: usize) -> Option<usize> {
        let begin = ARITY * node + 1;
        let end = (begin + ARITY).min(self.items.len());
        if begin >= end {
            return None;
        }
        let mut best = begin;
        for child in begin + 1..end {
            if self.precedes((self.costs[child], self.items[child]), (self.costs[best], self.items[best])) {
                best = child;
            }
        }
        Some(best)
    }

    #[inline]
    fn precedes(&self, (cost_a, a): (f64, u32), (cost_b, b): (f64, u32)) -> bool {
        if cost_a == cost_b { self.precedes_at_equal_cost(a as usize, b as usize) } else { cost_a < cost_b }
    }

    fn precedes_at_equal_cost(&self, a: usize, b: usize) -> bool {
        if let (Some(second_a), Some(second_b)) = (self.second_costs.get(a), self.second_costs.get(b))
            && second_a != second_b
        {
            return second_a < second_b;
        }
        let (length_a, length_b) = (self.lengths_squared[a], self.lengths_squared[b]);
        if length_a != length_b {
            return length_a < length_b;
        }
        let sorted = |[u, v]: [u32; 2]| (u.min(v), u.max(v));
        sorted(self.ends[a]) < sorted(self.ends[b])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream of numbers that look random, the same every time.
    struct Stream(u64);

    impl Stream {
        fn next(&mut self, below: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) % below
        }
    }

    fn rated(edge: u32, costs: [f64; 2], length_squared: f32, ends: [u32; 2]) -> Rated {
        Rated { edge, ends, length_squared, costs: Some(costs) }
    }

    fn drain(queue: &mut EdgeQueue) -> Vec<u32> {
        std::iter::from_fn(|| queue.pop()).collect()
    }

    #[test]
    fn ties_break_by_second_cost_then_length_then_vertices() {
        let entries = [
            rated(0, [1.0, 0.0], 0.0, [0, 1]),
            rated(1, [0.0, 1.0], 0.0, [0, 1]),
            rated(2, [0.0, 0.0], 2.0, [0, 1]),
            rated(3, [0.0, 0.0], 1.0, [9, 3]),
            rated(4, [0.0, 0.0], 1.0, [3, 8]),
            rated(5, [0.0, 0.0], 1.0, [7, 2]),
        ];
        let mut queue = EdgeQueue::new(vec![[0, 1]; 6], true, |edge, _| entries[edge as usize]);
        assert_eq!(drain(&mut queue), [5, 4, 3, 2, 1, 0]);
    }

    #[test]
    fn any_mix_of_operations_leaves_the_smallest_first() {
        let count = 200;
        let mut stream = Stream(1);
        let ends: Vec<[u32; 2]> = (0..count).map(|e| [e, e + 1]).collect();
        let mut expected: Vec<Option<u64>> = (0..count).map(|_| Some(stream.next(50))).collect();
        let start = expected.clone();
        let mut queue = EdgeQueue::new(ends, false, |edge, ends| {
            let costs = start[edge as usize].map(|c| [c as f64, 0.0]);
            Rated { edge, ends, length_squared: 0.0, costs }
        });
        for _ in 0..5000 {
            let edge = stream.next(count.into()) as u32;
            match stream.next(4) {
                0 => {
                    queue.remove(edge);
                    expected[edge as usize] = None;
                }
                1 => {
                    let first = (0..count).filter_map(|e| expected[e as usize].map(|c| (c, e))).min();
                    assert_eq!(queue.pop(), first.map(|(_, e)| e));
                    first.into_iter().for_each(|(_, e)| expected[e as usize] = None);
                }
                _ => {
                    let cost = stream.next(50);
                    queue.place(&rated(edge, [cost as f64, 0.0], 0.0, [edge, edge + 1]));
                    expected[edge as usize] = Some(cost);
                }
            }
            assert_eq!(queue.contains(edge), expected[edge as usize].is_some());
        }
    }
}
