//! Rows and numbers of the processes, without MPI.

use signorini_petsc::numbering::Numbering;
use signorini_petsc::rows::Rows;

#[test]
fn entries_are_summed_in_their_order_and_rows_are_sorted() {
    // In any other order the small number is lost.
    let entries = [(0, 2, 1e16), (1, 0, 3.0), (0, 2, -1e16), (0, 2, 1.0), (0, 1, 5.0)];
    let mut rows = Rows::new(2, entries.into_iter());
    assert_eq!(rows.row(0).collect::<Vec<_>>(), [(1, 5.0), (2, 1.0)]);
    rows.add(1, 1, 4.0);
    rows.add(1, 0, 1.0);
    assert_eq!(rows.row(1).collect::<Vec<_>>(), [(0, 4.0), (1, 4.0)]);
    assert_eq!((rows.count(), rows.row(0).count()), (2, 2));
}

#[test]
fn each_process_has_its_unknowns_in_their_order() {
    let numbering = Numbering::new(&[1, 0, 2, 1, 0], 4);
    assert_eq!(numbering.first, [0, 2, 4, 5, 5]);
    assert_eq!(numbering.unknown, [1, 4, 0, 3, 2]);
    assert!((0..5).all(|u| numbering.unknown[numbering.number[u] as usize] == u as u32));
    assert_eq!((numbering.rows(0), numbering.rows(3)), (2, 0));
}
