//! The queue of edges, cheapest first.

use crate::mesh::adjacency::NONE;

/// Children of a heap node. Four halve the depth against two, and their costs share a cache line.
const ARITY: usize = 4;

/// What orders an edge, beside its cost.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    /// Its two vertices.
    pub ends: [u32; 2],
    /// Its squared length in unit-sphere coordinates, rounded so that lengths equal but for rounding are equal.
    pub length_squared: f32,
}

/// A key in the making: what [`EdgeQueue::set`] puts an edge under.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// First criterion.
    pub cost: f64,
    /// Second criterion, ignored by a queue without second costs.
    pub second_cost: f64,
    /// The further criteria: length, smaller vertex, larger vertex.
    pub edge: Edge,
}

/// An indexed heap of edges by (cost, second cost, length, smaller vertex, larger vertex), all ascending.
///
/// The key of an edge changes only inside [`EdgeQueue::set`], so that the heap stays in order between any two calls.
#[derive(Debug)]
pub struct EdgeQueue {
    costs: Vec<f64>,
    items: Vec<u32>,
    place: Vec<u32>,
    edges: Vec<Edge>,
    second_costs: Vec<f64>,
}

impl EdgeQueue {
    /// A queue of these edges by their keys, in linear time. `None` keeps an edge out for now.
    ///
    /// Second costs are stored only if `has_second_cost`.
    pub fn new(ends: &[[u32; 2]], has_second_cost: bool, mut key: impl FnMut([u32; 2]) -> (Edge, Option<Key>)) -> Self {
        let count = ends.len();
        let mut queue = Self {
            costs: Vec::with_capacity(count),
            items: Vec::with_capacity(count),
            place: vec![NONE; count],
            edges: Vec::with_capacity(count),
            second_costs: vec![0.0; if has_second_cost { count } else { 0 }],
        };
        for (id, &ends) in ends.iter().enumerate() {
            let (edge, key) = key(ends);
            queue.edges.push(edge);
            if let Some(key) = key {
                queue.place[id] = queue.items.len() as u32;
                queue.items.push(id as u32);
                queue.costs.push(key.cost);
                if has_second_cost {
                    queue.second_costs[id] = key.second_cost;
                }
            }
        }
        for node in (0..queue.items.len().div_ceil(ARITY)).rev() {
            queue.sift_down(node);
        }
        queue
    }

    /// The two vertices of an edge.
    pub fn ends(&self, edge: u32) -> [u32; 2] {
        self.edges[edge as usize].ends
    }

    /// Whether the edge waits in the queue.
    pub fn contains(&self, edge: u32) -> bool {
        self.place[edge as usize] != NONE
    }

    /// Takes the first edge out.
    pub fn pop(&mut self) -> Option<u32> {
        let &first = self.items.first()?;
        self.remove(first);
        Some(first)
    }

    /// Takes an edge out, if it is there.
    pub fn remove(&mut self, edge: u32) {
        let node = std::mem::replace(&mut self.place[edge as usize], NONE) as usize;
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

    /// Puts an edge under a new key, whether or not it was in the queue.
    pub fn set(&mut self, edge: u32, key: Key) {
        self.edges[edge as usize] = key.edge;
        if let Some(second) = self.second_costs.get_mut(edge as usize) {
            *second = key.second_cost;
        }
        let mut node = self.place[edge as usize] as usize;
        if node >= self.items.len() {
            node = self.items.len();
            self.items.push(edge);
            self.costs.push(key.cost);
        }
        self.put(node, key.cost, edge);
        self.restore(node);
    }

    /// Takes an edge out and gives it new ends, for an edge that may not collapse.
    pub fn set_aside(&mut self, edge: u32, record: Edge) {
        self.remove(edge);
        self.edges[edge as usize] = record;
    }

    fn restore(&mut self, node: usize) {
        if !self.sift_up(node) {
            self.sift_down(node);
        }
    }

    fn put(&mut self, node: usize, cost: f64, item: u32) {
        self.costs[node] = cost;
        self.items[node] = item;
        self.place[item as usize] = node as u32;
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
        let (a, b) = (&self.edges[a], &self.edges[b]);
        if a.length_squared != b.length_squared {
            return a.length_squared < b.length_squared;
        }
        let sorted = |[u, v]: [u32; 2]| (u.min(v), u.max(v));
        sorted(a.ends) < sorted(b.ends)
    }
}
