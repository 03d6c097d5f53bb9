use signorini_membrane::{domain::*, field::*, problem::*, equilibrium::*, front::*, line_zone::*, scales::*, zone::*};
use signorini_fem::Grid; use signorini_geometry::*; use std::sync::Arc;
fn main(){
    let b=Aabb::new(Point::<1>::new(-1.0),Point::<1>::new(1.0)); let grid=Grid::<1>::new(b,[40],4);
    let sup=||Some(Support{index:0,displacement:Arc::new(Constant(0.0)) as SharedField<1>});
    let m=Membrane{ domain: DomainOnGrid::new(Arc::new(BoxDomain(b)),&grid), grid:grid.clone(), measure: Measure::Plain, tension: Arc::new(Constant(1.0)), load: Arc::new(Constant(-1.0)), floor: Some(Arc::new(Constant(-0.1))), supports: vec![sup(), sup()], support_count:1};
    let mut e=Elements::new(&m);
    let free=Equilibrium::solve(&m,&LineZone::empty(&grid),&mut e).unwrap(); let sc=Scales::of_free(&free); println!("{sc:?} u0 {:?}", free.displacement(&LineZone::empty(&grid),&Point::<1>::new(0.0)));
    for c in [0.8f64+1e-13,0.8-1e-13,0.8+1.2e-16,0.8-1.2e-16,0.8-3e-16,0.8+3e-16, 0.7999999, 0.8000001]{
    let z=LineZone::new(&grid,vec![[-c,c]]);
    let eq=Equilibrium::solve(&m,&z,&mut e).unwrap(); let f=Fronts::new(&eq);
    println!("c {c} rho {:?} p {:?} pts {:?}", f.slope_jump, f.pressure, eq.quadrature.front);
    let s=f.newton_step(&z,&sc).unwrap(); println!("{:?} {}", s.coefficients, s.action);
    println!("{:?}", f.slope_jump_rate(&z,&[1.0,1.0]));
    }
}
