//! The edges of a graph of numbers, laid out by vertex.

/// For each vertex, others.
pub(crate) struct Edges {
    all: Vec<u32>,
    bounds: Vec<u32>,
}

/// Visits what a vertex leads to.
type Each<'a> = &'a dyn Fn(u32, &mut dyn FnMut(u32));

impl Edges {
    /// What each of the vertices below `count` leads to.
    pub(crate) fn of(count: usize, each: Each<'_>) -> Self {
        let (mut all, mut bounds) = (Vec::new(), Vec::with_capacity(count + 1));
        bounds.push(0);
        for vertex in 0..count as u32 {
            each(vertex, &mut |other| all.push(other));
            bounds.push(all.len() as u32);
        }
        Self { all, bounds }
    }

    /// What leads to each of them.
    pub(crate) fn reversed(count: usize, each: Each<'_>) -> Self {
        let mut bounds = vec![0_u32; count + 1];
        for vertex in 0..count as u32 {
            each(vertex, &mut |other| bounds[other as usize + 1] += 1);
        }
        for at in 1..bounds.len() {
            bounds[at] += bounds[at - 1];
        }
        let mut all = vec![0; bounds.last().map_or(0, |&count| count as usize)];
        let mut next = bounds.clone();
        for vertex in 0..count as u32 {
            each(vertex, &mut |other| {
                let at = &mut next[other as usize];
                all[*at as usize] = vertex;
                *at += 1;
            });
        }
        Self { all, bounds }
    }

    pub(crate) fn of_vertex(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.all[self.bounds[vertex] as usize..self.bounds[vertex + 1] as usize]
    }
}
