//! What a run of solids goes on from, as JSON.

use serde_json::{Value, json};
use signorini_solid::{Memory, Settled};

/// The state between two increments.
pub fn to_json(memory: Memory) -> Value {
    let settled = memory.settled.map(|Settled { u, pressure }| {
        let mut pressure: Vec<_> = pressure.into_iter().collect();
        pressure.sort_by_key(|(key, _)| *key);
        json!({"u": u, "pressure": pressure})
    });
    json!({"active": memory.active, "settled": settled})
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
    Some(Memory { active: take(&mut v["active"])?, settled, friction: None })
}
