//! Queries of the `polyanya` crate on one scene, timed: JSON in, JSON out. Run by ../../peers.py.
//!
//! In: {"outer": [[x, y], ...], "holes": [[[x, y], ...], ...], "pairs": [[x0, y0, x1, y1], ...], "repeat": N,
//! "scale": units of the mesh a metre}
//! The holes are the obstacles already grown by the disc's radius, disjoint. The mesh's polygons are merged and baked
//! before any query, as the crate advises; that time is "mesh_ms". Of each pair the length and the median and 99th
//! percentile of `repeat` runs of `Mesh::path`.

use glam::Vec2;
use polyanya::{Mesh, Triangulation};
use serde_json::{json, Value};
use std::io::Read;
use std::time::Instant;

fn point(x: &Value, y: &Value, scale: f64) -> Vec2 {
    Vec2::new((x.as_f64().unwrap() * scale) as f32, (y.as_f64().unwrap() * scale) as f32)
}

fn ring(v: &Value, scale: f64) -> Vec<Vec2> {
    v.as_array().unwrap().iter().map(|p| point(&p[0], &p[1], scale)).collect()
}

fn mesh_of(scene: &Value, scale: f64) -> Mesh {
    let mut triangulation = Triangulation::from_outer_edges(&ring(&scene["outer"], scale));
    for hole in scene["holes"].as_array().unwrap() {
        triangulation.add_obstacle(ring(hole, scale));
    }
    let mut mesh = triangulation.as_navmesh();
    for _ in 0..3 {
        mesh.merge_polygons();
    }
    mesh.bake();
    mesh
}

fn run(mesh: &Mesh, pair: &Value, repeat: usize, scale: f64) -> Value {
    let (from, to) = (point(&pair[0], &pair[1], scale), point(&pair[2], &pair[3], scale));
    let mut ms = Vec::with_capacity(repeat);
    let mut length = Value::Null;
    for _ in 0..repeat {
        let started = Instant::now();
        let path = mesh.path(from, to);
        ms.push(started.elapsed().as_secs_f64() * 1e3);
        if let Some(path) = path {
            // In double, from the points: the crate's own sum is single.
            let mut at = from;
            let mut sum = 0.0f64;
            for p in &path.path {
                let (dx, dy) = ((p.x - at.x) as f64, (p.y - at.y) as f64);
                sum += (dx * dx + dy * dy).sqrt();
                at = *p;
            }
            length = json!(sum / scale);
        }
    }
    ms.sort_by(|a, b| a.total_cmp(b));
    json!({"length": length, "ms": ms[ms.len() / 2], "p99": ms[(ms.len() * 99 / 100).min(ms.len() - 1)]})
}

fn main() {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).unwrap();
    let scene: Value = serde_json::from_str(&text).unwrap();
    let scale = scene["scale"].as_f64().unwrap();
    let started = Instant::now();
    let mesh = mesh_of(&scene, scale);
    let mesh_ms = started.elapsed().as_secs_f64() * 1e3;
    let repeat = scene["repeat"].as_u64().unwrap().max(1) as usize;
    let pairs: Vec<Value> = scene["pairs"].as_array().unwrap().iter().map(|p| run(&mesh, p, repeat, scale)).collect();
    println!("{}", json!({"mesh_ms": mesh_ms, "polygons": mesh.layers[0].polygons.len(), "pairs": pairs}));
}
