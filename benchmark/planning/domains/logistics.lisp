; Parcels travel by truck within a city and by airplane between airports. All parcels are tasks
; without an order, so their steps interleave: a vehicle that was sent to a place for one parcel is
; protected there until that parcel is in or out, and no other parcel may send it away.
;
; The vocabulary is that of the logistics problems which come with SHOP, so that their problem files
; fit this domain as well.

(defdomain logistics (

  ; Loading and unloading give up the claim on the vehicle that going there made.
  (:operator (!load-truck ?parcel ?truck ?place)
    ((obj-at ?parcel ?place) (:protection (truck-at ?truck ?place)))
    ((in-truck ?parcel ?truck)))
  (:operator (!unload-truck ?parcel ?truck ?place)
    ((in-truck ?parcel ?truck) (:protection (truck-at ?truck ?place)))
    ((obj-at ?parcel ?place)))
  (:operator (!load-airplane ?parcel ?airplane ?airport)
    ((obj-at ?parcel ?airport) (:protection (airplane-at ?airplane ?airport)))
    ((in-airplane ?parcel ?airplane)))
  (:operator (!unload-airplane ?parcel ?airplane ?airport)
    ((in-airplane ?parcel ?airplane) (:protection (airplane-at ?airplane ?airport)))
    ((obj-at ?parcel ?airport)))

  (:operator (!drive-truck ?truck ?from ?to)
    ((truck-at ?truck ?from))
    ((truck-at ?truck ?to) (:protection (truck-at ?truck ?to))))
  (:operator (!fly-airplane ?airplane ?from ?to)
    ((airplane-at ?airplane ?from))
    ((airplane-at ?airplane ?to) (:protection (airplane-at ?airplane ?to))))

  ; For a vehicle that is there already.
  (:operator (!add-protection ?fact) () ((:protection ?fact)) 0)

  ; obj-at: the parcel shall be at the place.
  (:method (obj-at ?parcel ?goal)
    within-the-city
    ((obj-at ?parcel ?start) (in-city ?goal ?city) (in-city ?start ?city) (truck ?truck ?city))
    ((by-truck ?truck ?parcel ?start ?goal))

    to-another-city
    ((obj-at ?parcel ?start)
     (in-city ?start ?here) (truck ?first-truck ?here)
     (in-city ?goal ?there) (truck ?last-truck ?there)
     (airport ?departure) (in-city ?departure ?here)
     (airport ?arrival) (in-city ?arrival ?there))
    ((by-truck ?first-truck ?parcel ?start ?departure)
     (by-airplane ?parcel ?departure ?arrival)
     (by-truck ?last-truck ?parcel ?arrival ?goal)))

  (:method (by-truck ?truck ?parcel ?start ?goal)
    nothing-to-do
    ((eval (eq '?start '?goal)))
    ()

    carry
    ()
    ((bring-truck ?truck ?start)
     (:task :immediate !load-truck ?parcel ?truck ?start)
     (bring-truck ?truck ?goal)
     (:task :immediate !unload-truck ?parcel ?truck ?goal)))

  (:method (bring-truck ?truck ?place)
    is-there
    ((truck-at ?truck ?place))
    ((:task :immediate !add-protection (truck-at ?truck ?place)))

    drive
    ((truck-at ?truck ?from))
    ((:task :immediate !drive-truck ?truck ?from ?place)))

  (:method (by-airplane ?parcel ?departure ?arrival)
    is-there
    ((airplane-at ?airplane ?departure))
    ((:task :immediate !add-protection (airplane-at ?airplane ?departure))
     (!load-airplane ?parcel ?airplane ?departure)
     (bring-airplane ?airplane ?arrival)
     (!unload-airplane ?parcel ?airplane ?arrival))

    call-one
    ((airplane-at ?airplane ?from))
    ((:task :immediate !fly-airplane ?airplane ?from ?departure)
     (!load-airplane ?parcel ?airplane ?departure)
     (bring-airplane ?airplane ?arrival)
     (!unload-airplane ?parcel ?airplane ?arrival)))

  (:method (bring-airplane ?airplane ?airport)
    is-there
    ((airplane-at ?airplane ?airport))
    ((:task :immediate !add-protection (airplane-at ?airplane ?airport)))

    fly
    ((airplane-at ?airplane ?from))
    ((:task :immediate !fly-airplane ?airplane ?from ?airport)))))
