//! The strongly connected components of a graph of numbers, by Tarjan, without recursion.

/// Components in an order in which each comes after all that it leads to.
pub(crate) struct Components {
    /// All vertices, a component after another.
    members: Vec<u32>,
    /// Where each component begins, and the end of the last.
    bounds: Vec<u32>,
    /// The component of each vertex.
    pub(crate) of: Vec<u32>,
}

const UNSEEN: u32 = u32::MAX;

struct Walk {
    index: Vec<u32>,
    low: Vec<u32>,
    open: Vec<u32>,
    /// The vertices on the way, each with how many of its successors have been looked at.
    way: Vec<(u32, usize)>,
    next: u32,
    components: Components,
}

impl Components {
    /// Those of the vertices below `count`; `successor` gives a vertex's successors by number until
    /// there are no more.
    pub(crate) fn of(count: usize, successor: impl Fn(u32, usize) -> Option<u32>) -> Self {
        let mut walk = Walk {
            index: vec![UNSEEN; count],
            low: vec![0; count],
            open: Vec::new(),
            way: Vec::new(),
            next: 0,
            components: Self {
                members: Vec::with_capacity(count),
                bounds: vec![0],
                of: vec![UNSEEN; count],
            },
        };
        for root in 0..count as u32 {
            if walk.index[root as usize] == UNSEEN {
                walk.enter(root);
                walk.run(&successor);
            }
        }
        walk.components
    }

    /// The components, each after all that it leads to.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.bounds.windows(2).map(|pair| &self.members[pair[0] as usize..pair[1] as usize])
    }

    pub(crate) fn len(&self) -> usize {
        self.bounds.len() - 1
    }
}

impl Walk {
    fn enter(&mut self, vertex: u32) {
        self.index[vertex as usize] = self.next;
        self.low[vertex as usize] = self.next;
        self.next += 1;
        self.open.push(vertex);
        self.way.push((vertex, 0));
    }

    fn run(&mut self, successor: &impl Fn(u32, usize) -> Option<u32>) {
        while let Some((vertex, looked)) = self.way.last_mut() {
            let vertex = *vertex;
            let Some(next) = successor(vertex, *looked) else {
                self.leave(vertex);
                continue;
            };
            *looked += 1;
            if self.index[next as usize] == UNSEEN {
                self.enter(next);
            } else if self.components.of[next as usize] == UNSEEN {
                let index = self.index[next as usize];
                let low = &mut self.low[vertex as usize];
                *low = index.min(*low);
            }
        }
    }

    fn leave(&mut self, vertex: u32) {
        self.way.pop();
        let low = self.low[vertex as usize];
        if let Some((before, _)) = self.way.last() {
            let outer = &mut self.low[*before as usize];
            *outer = low.min(*outer);
        }
        if low != self.index[vertex as usize] {
            return;
        }
        let component = self.components.len() as u32;
        while let Some(member) = self.open.pop() {
            self.components.of[member as usize] = component;
            self.components.members.push(member);
            if member == vertex {
                break;
            }
        }
        self.components.bounds.push(self.components.members.len() as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_component_comes_after_what_it_leads_to() {
        // 0 -> 1 <-> 2 -> 3, 4 -> 4
        let edges: [&[u32]; 5] = [&[1], &[2], &[1, 3], &[], &[4]];
        let found = Components::of(5, |vertex, at| edges[vertex as usize].get(at).copied());
        let mut sorted: Vec<Vec<u32>> = found.iter().map(<[u32]>::to_vec).collect();
        sorted.iter_mut().for_each(|members| members.sort_unstable());
        assert_eq!(sorted, [vec![3], vec![1, 2], vec![0], vec![4]]);
        assert_eq!(found.of[1], found.of[2]);
        assert_eq!(found.len(), 4);
    }
}
