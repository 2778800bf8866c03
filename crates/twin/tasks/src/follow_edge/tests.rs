//! Tests of the progress that counts.

use super::*;

fn task() -> FollowEdge {
    FollowEdge::on(&FastGel::phystac().unwrap()).unwrap()
}

#[test]
fn once_around_a_disc_is_its_circumference() {
    let task = task();
    let mut episode = task.begin(8, &mut twintac_random::stream(1, "disc"));
    (episode.body, episode.yaw_rad, episode.sense) = (1, 0.7, -1.0);
    episode.object_mm = DVec2::new(2.0, -1.0);
    let on_edge = |part: f64| 9.5 * DVec2::from_angle(-2.0 * PI * part);
    episode.at_mm = episode.object_mm + on_edge(0.0);
    episode.nearest = task.nearest(&episode);
    let mut reward_mm = 0.0;
    for step in 1..=300 {
        let at_mm = episode.object_mm + on_edge(f64::from(step) / 300.0);
        episode.moved_mm = at_mm.distance(episode.at_mm);
        episode.at_mm = at_mm;
        let felt = Felt {
            readings_kpa: &[],
            before_kpa: &[],
            force_n: 2.0,
        };
        reward_mm += task.feel(&mut episode, &felt).reward;
    }
    let around_mm = 2.0 * PI * 9.5;
    assert!(
        (reward_mm - around_mm).abs() < 0.01 * around_mm,
        "{reward_mm} of {around_mm}"
    );
}

#[test]
fn the_force_has_to_be_moderate_and_the_edge_near() {
    let task = task();
    let start = task.begin(8, &mut twintac_random::stream(2, "edge"));
    let reward = |beside_mm: f64, force_n: f64| {
        let mut episode = start.clone();
        let (edge_mm, outward) = task.edges[start.body as usize].at(0.3);
        let turned = |at: DVec2| start.object_mm + DVec2::from_angle(start.yaw_rad).rotate(at);
        let way = start.sense * outward.perp();
        episode.at_mm = turned(edge_mm + beside_mm * outward);
        episode.nearest = task.nearest(&episode);
        episode.at_mm = turned(edge_mm + beside_mm * outward + 0.2 * way);
        episode.moved_mm = 0.2;
        let felt = Felt {
            readings_kpa: &[],
            before_kpa: &[],
            force_n,
        };
        task.feel(&mut episode, &felt)
    };
    assert!(
        (reward(0.0, 2.0).reward - 0.2).abs() < 0.01,
        "{:?}",
        reward(0.0, 2.0)
    );
    assert!(reward(1.5, 2.0).reward < 0.8 * reward(0.0, 2.0).reward);
    assert_eq!(reward(3.5, 2.0).reward, 0.0);
    assert_eq!(reward(0.0, 0.0).reward, 0.0);
    assert!(reward(0.0, 8.0).reward < 0.0);
    assert!(reward(0.0, 16.0).terminated && reward(9.0, 2.0).terminated);
}
