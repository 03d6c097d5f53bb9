//! What a run of solids goes on from, as JSON.

use serde_json::{Value, json};
use signorini_solid::{FrictionHistory, Memory, Settled};

/// The state between two increments.
pub fn to_json(memory: Memory) -> Value {
    let settled = memory.settled.map(|Settled { u, pressure }| {
        let mut pressure: Vec<_> = pressure.into_iter().collect();
        pressure.sort_by_key(|(key, _)| *key);
        json!({"u": u, "pressure": pressure})
    });
    let friction = memory.friction.map(|FrictionHistory { u, motion, traction, slip }| {
        json!({"u": u, "motion": motion, "traction": traction, "slip": slip})
    });
    json!({"active": memory.active, "settled": settled, "friction": friction})
}

/// Reads what [`to_json`] wrote; none where it is damaged.
pub fn from_json(mut v: Value) -> Option<Memory> {
    fn take<T: serde::de::DeserializeOwned>(v: &mut Value) -> Option<T> {
        serde_json::from_value(v.take()).ok()
    }
    let settled = match v["settled"].take() {
        Value::Null => None,
        mut s => {
            let pressure: Vec<_> = take(&mut s["pressure"])?;
            Some(Settled { u: take(&mut s["u"])?, pressure: pressure.into_iter().collect() })
        }
    };
    let friction = match v["friction"].take() {
        Value::Null => None,
        mut f => Some(FrictionHistory {
            u: take(&mut f["u"])?,
            motion: take(&mut f["motion"])?,
            traction: take(&mut f["traction"])?,
            slip: take(&mut f["slip"])?,
        }),
    };
    Some(Memory { active: take(&mut v["active"])?, settled, friction })
}
