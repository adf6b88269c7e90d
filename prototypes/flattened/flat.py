"""Adhesion of flattened contacts, dimensionless: s = a/a0, F in F0, alpha in F0/(E* a0), chi = Gamma E*/(p0^2 a0)."""
import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
pi=np.pi
def F(s,t): return (1-t)*s**3+2*t/pi*(np.arcsin(s)-s*np.sqrt(1-s*s))
def al(s,t):
    A,B=.75*(1-t),2*t/pi
    return A*s*s+B*(1-np.sqrt(1-s*s))
def dal(s,t):
    A,B=.75*(1-t),2*t/pi
    return 2*A*s+B*s/np.sqrt(1-s*s)
k=lambda chi: np.sqrt(2*chi/pi)          # delta = k sqrt(s) ; delta/(F0/E*a0)= sqrt(2 pi Gamma a/E*) E* a0/F0
def U(s,t): return quad(lambda x:F(x,t)*dal(x,t),0,s,epsabs=1e-14,epsrel=1e-13)[0]
for t in (0,.5,1):
    c=(1-t)+4*t/(3*pi)
    s=1e-3
    print("tau",t,"F/(c s^3)-1",F(s,t)/(c*s**3)-1,"al/(.75 c s^2)-1",al(s,t)/(.75*c*s*s)-1)
    # energy on the adhesive curve: quadrature of F dalpha against U - F delta + pi Gamma a^2 (= k^2 s^2 /2)
    for chi in (.01,.1):
        K=k(chi)
        num=quad(lambda x:(F(x,t)-2*K*x**1.5)*(dal(x,t)-.5*K/np.sqrt(x)),0,.7,epsabs=1e-13,epsrel=1e-12)[0]
        s=.7; closed=U(s,t)-F(s,t)*K*np.sqrt(s)+.5*K*K*s*s
        print("   energy chi",chi,num,closed,num-closed)
    for chi in (1e-4,1e-3,1e-2,.1,.3,.39,1):
        K=k(chi)
        m=minimize_scalar(lambda s:F(s,t)-2*K*s**1.5,bounds=(1e-9,.999999),method='bounded',options=dict(xatol=1e-12))
        Rp=4/(3*c)   # in E* a0^3/F0
        jkr=1.5*pi*Rp*(chi/pi**2)  # Gamma = chi p0^2 a0/E*, p0=F0/(pi a0^2): Gamma R'/F0 = chi/pi^2 * Rp
        g=lambda s:dal(s,t)-.5*K/np.sqrt(s)
        sf=brentq(g,1e-12,.9999999) if g(.9999999)>0 else float('nan')
        sj=(K/2/(1.5*c))**(2/3)
        print(f"   chi {chi:7.4f} pull-off/F0 {-m.fun:.6f} over 3/2 pi Gamma R' {-m.fun/jkr:.6f} at s {m.x:.4f}; fold s {sf:.4f} (small s {sj:.4f}), F fold {F(sf,t)-2*K*sf**1.5:.5f}, gap {al(sf,t)-K*np.sqrt(sf):.5f}")
