use signorini_mechanics::{ContactLaw, Enforcement};

#[test]
fn soft_trials_go_on_as_they_were_saved() {
    let law = || ContactLaw::new(Enforcement::Multiplier, vec![2.0, 3.0], vec![1.0; 2]);
    let scales = |law: &ContactLaw| law.scales().collect::<Vec<_>>();
    let (mut saved, stiff) = (law(), scales(&law()));
    assert!(saved.make_trials(true) && scales(&saved) != stiff);
    let numbers: Vec<f64> = saved.scales().chain([7.0]).collect();
    let mut again = law();
    assert_eq!(again.restore_scales(&numbers), Some(&[7.0][..]));
    assert_eq!(scales(&again), scales(&saved));
    // They are soft already, and become as stiff as they were.
    assert!(!again.make_trials(true) && again.make_trials(false));
    assert_eq!(scales(&again), stiff);
    assert!(law().restore_scales(&numbers[..3]).is_none());
}
