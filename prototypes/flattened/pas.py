import numpy as np
from epdem.theory.cavity import Cavity
from epdem.theory.thornton import Thornton
import inspect
E=215e9/(2*.91); R=1e-5
def tau_of(law,al):
    return None
for name,law in (("cavity Y=357MPa",Cavity(E_star=E,R_star=R,Y=1e9/2.8)),("thornton p=1GPa",Thornton(E_star=E,R_star=R,p_y=1e9))):
    ay=law.yield_overlap
    al=ay*np.logspace(np.log10(1.0005),5,4000)
    F,a=law.force(al),law.radius(al)
    W=law.work(al)
    try: t=law.flatness(al)
    except Exception as e: t=np.zeros_like(al) if 'thornton' in name else None
    if t is None:
        print([m for m in dir(law) if not m.startswith('__')]); continue
    U=F*F/(E*a)*(0.3*(1-t)**2+.5625*t*(1-t)+8/(3*np.pi**2)*t*t)
    d=lambda y:np.gradient(y,al)
    num=F-d(U); den=2*E*a-d(F)
    ok=den>1e-6*2*E*a
    delta=np.where(ok,num/den,np.inf)
    G=delta**2*E/(2*np.pi*a)
    p=F/(np.pi*a*a); chi=G*E/(p*p*a)
    for i in (1,10,100,300,1000,2000,3000,3990): print(name,f"alpha/alpha_y {al[i]/ay:.4g} tau {t[i]:.3f} largest Gamma {G[i]:.4g} J/m2 chi {chi[i]:.3f}")
    aY=law.radius(ay); pY=law.force(ay)/(np.pi*aY**2)
    print("min",np.nanmin(G[5:-5]),"J/m^2; p^3R/E^2 =",pY**3*R/E**2, "a_y",aY)
